// Light or dark: the system's choice until a person makes their own, which this browser then remembers.

const KEY = 'qhat-theme';

export class Theme {
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private systemDark = $state(this.system.matches);
  private chosen = $state<'light' | 'dark' | null>(remembered());

  constructor() {
    this.system.addEventListener('change', (event) => {
      this.systemDark = event.matches;
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
      // a browser that keeps nothing still changes its colours now
    }
  }

  /** Marks the document, for the style sheet. */
  show(): void {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
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
