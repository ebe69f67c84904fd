import { mount } from 'svelte';
import App from './App.svelte';
import './style/colours.css';
import './style/base.css';
import './style/narrow.css';
import './style/controls.css';
import './style/inputs.css';
import './style/reading.css';

mount(App, { target: document.getElementById('app')! });
