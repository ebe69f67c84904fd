// Which panels are open. In a window as narrow as a phone the panels are a sheet at the bottom.

export type Tab = 'controls' | 'plots' | 'terms';

/** Windows at most this wide have the sheet; wider windows have a column of panels. */
const NARROW = '(max-width: 820px)';

const TABS: readonly [Tab, string][] = [
  ['controls', 'Controls'],
  ['plots', 'Plots'],
  ['terms', 'Terms'],
];

export class Panels {
  private readonly query = matchMedia(NARROW);
  narrow = $state(this.query.matches);
  tab = $state<Tab>('controls');
  sheetOpen = $state(false);
  help = $state(false);

  constructor() {
    this.query.addEventListener('change', ({ matches }) => {
      this.narrow = matches;
      // a column shows the plots beside every tab
      if (!matches && this.tab === 'plots') this.tab = 'controls';
    });
  }

  get open(): boolean {
    return !this.narrow || this.sheetOpen;
  }

  get tabs(): readonly [Tab, string][] {
    return this.narrow ? TABS : TABS.filter(([tab]) => tab !== 'plots');
  }

  pick(tab: Tab): void {
    // on a phone a second touch on the open tab closes the sheet
    if (this.narrow) this.sheetOpen = !(this.sheetOpen && this.tab === tab);
    this.tab = tab;
  }

  toggleTerms(): void {
    this.pick(this.narrow || this.tab !== 'terms' ? 'terms' : 'controls');
  }
}
