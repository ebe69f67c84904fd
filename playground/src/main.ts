import { mount } from 'svelte';
import App from './App.svelte';
import './style/colours.css';
import './style/base.css';
import './style/layout.css';
import './style/narrow.css';
import './style/controls.css';
import './style/inputs.css';
import './style/reading.css';
import './style/help.css';

mount(App, { target: document.getElementById('app')! });
