// Light or dark: the system's choice until a person makes a choice, which this browser then remembers.

import { type Palette, readPalette } from './view/palette';

const KEY = 'qhat-theme';

export class Theme {
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private systemDark = $state(this.system.matches);
  private chosen = $state<'light' | 'dark' | null>(remembered());
  /** the colours that canvas, plots and matrices draw with, read anew when the theme changes */
  palette = $state.raw(this.show());

  constructor() {
    this.system.addEventListener('change', (event) => {
      this.systemDark = event.matches;
      this.palette = this.show();
    });
  }

  get dark(): boolean {
    return this.chosen ? this.chosen === 'dark' : this.systemDark;
  }

  toggle(): void {
    this.chosen = this.dark ? 'light' : 'dark';
    try {
      localStorage.setItem(KEY, this.chosen);
    } catch {
      // the colours change also in a browser that cannot store the choice
    }
    this.palette = this.show();
  }

  /** Names the theme on the document, for the style sheets, and reads their colours. */
  private show(): Palette {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
    return readPalette();
  }
}

function remembered(): 'light' | 'dark' | null {
  try {
    const value = localStorage.getItem(KEY);
    return value === 'light' || value === 'dark' ? value : null;
  } catch {
    return null;
  }
}
