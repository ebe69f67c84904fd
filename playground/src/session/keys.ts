// Everything a hand on the canvas or a button can do, from the keyboard.

import type { Selection } from '../view/picture';
import type { Stage } from '../view/stage';
import type { Session } from './session.svelte';

/** Shown in the help; the order is the order there. */
export const KEYS: readonly [string, string][] = [
  ['Space', 'play or pause'],
  ['.', 'one step'],
  ['r', 'reset to the start'],
  ['< >', 'slower, faster'],
  ['[ ]', 'previous, next particle'],
  ['{ }', 'previous, next rod or rope'],
  ['Arrows', 'pull the selected particle; with none selected, move the view'],
  ['Shift + arrows', 'turn a 3D view'],
  ['+ −', 'zoom'],
  ['f', 'fit the view'],
  ['g', 'compare with the ghost'],
  ['t', 'terms'],
  ['l', 'light or dark'],
  ['Esc', 'let go, clear the selection'],
  ['?', 'these keys'],
];

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4] as const;

const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
/** One press of an arrow moves the view, or the hand that pulls, this far, px. */
const STRIDE = 24;

export interface PageCommands {
  toggleTheme(): void;
  toggleTerms(): void;
  toggleHelp(): void;
}

export class Keys {
  private hand: { anchor: number[]; x: number; y: number } | null = null;
  private readonly held = new Set<string>();

  constructor(
    private readonly session: Session,
    private readonly stage: Stage,
    private readonly page: PageCommands,
  ) {
    window.addEventListener('keydown', this.down);
    window.addEventListener('keyup', this.up);
    window.addEventListener('blur', this.letGo);
  }

  private readonly down = (event: KeyboardEvent) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    let target = event.target instanceof Element ? event.target : document.body;
    const dialog = target.closest('dialog');
    // an open dialog closes itself
    if (dialog?.open) return;
    // focus stays in a dialog for a moment after it has closed; what is not there cannot answer
    if (dialog) target = document.body;
    if (target.closest('input, select, textarea') && event.key !== 'Escape') return;
    // a focused button answers to space itself
    if (event.key === ' ' && target.closest('button, summary')) return;
    if (this.act(event)) event.preventDefault();
  };

  private act(event: KeyboardEvent): boolean {
    const { session, stage } = this;
    const arrow = ARROWS[event.key];
    if (arrow) return this.arrow(event, arrow);
    switch (event.key) {
      case ' ':
        session.toggle();
        return true;
      case '.':
        session.stepOnce();
        return true;
      case 'r':
        session.reset();
        return true;
      case '<':
      case '>':
        this.changeSpeed(event.key === '>' ? 1 : -1);
        return true;
      case '[':
      case ']':
        this.next('particle', event.key === ']' ? 1 : -1);
        return true;
      case '{':
      case '}':
        this.next('link', event.key === '}' ? 1 : -1);
        return true;
      case '+':
      case '=':
        stage.zoom(1.25);
        return true;
      case '-':
        stage.zoom(0.8);
        return true;
      case 'f':
        stage.fit();
        return true;
      case 'g':
        session.setCompare(!session.compare);
        return true;
      case 't':
        this.page.toggleTerms();
        return true;
      case 'l':
        this.page.toggleTheme();
        return true;
      case '?':
        this.page.toggleHelp();
        return true;
      case 'Escape':
        this.letGo();
        session.select(null);
        (document.activeElement as HTMLElement | null)?.blur();
        return true;
      default:
        return false;
    }
  }

  private changeSpeed(by: number): void {
    const index = SPEEDS.findIndex((speed) => speed >= this.session.speed);
    this.session.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, index + by))]);
  }

  private next(kind: 'particle' | 'link', by: number): void {
    const { structure, selection } = this.session;
    const count = kind === 'particle' ? (structure?.masses.length ?? 0) : (structure?.links.length ?? 0);
    if (count === 0) return;
    const index = selection?.kind === kind ? selection.index + by : by > 0 ? 0 : count - 1;
    this.session.select({ kind, index: (index + count) % count } as Selection);
  }

  private arrow(event: KeyboardEvent, [dx, dy]: [number, number]): boolean {
    const { session, stage } = this;
    if (event.shiftKey && stage.camera.dimension === 3) {
      stage.orbit(dx * 0.1, dy * 0.1);
      return true;
    }
    const particle = session.selection?.kind === 'particle' ? session.selection.index : null;
    if (particle === null || session.structure?.fixed[particle]) {
      stage.pan(-dx * STRIDE, -dy * STRIDE);
      return true;
    }
    if (!this.hand) {
      const anchor = stage.positionOf(particle);
      const screen = [0, 0, 0];
      stage.camera.project(anchor, 0, screen);
      this.hand = { anchor, x: screen[0], y: screen[1] };
    }
    this.held.add(event.key);
    this.hand.x += dx * STRIDE;
    this.hand.y += dy * STRIDE;
    const target = stage.camera.unproject(this.hand.x, this.hand.y, this.hand.anchor);
    if (session.mouse) session.dragTo(target);
    else session.grab(particle, target);
    return true;
  }

  private readonly up = (event: KeyboardEvent) => {
    this.held.delete(event.key);
    if (this.hand && this.held.size === 0) this.letGo();
  };

  private readonly letGo = () => {
    if (!this.hand) return;
    this.hand = null;
    this.held.clear();
    this.session.release();
  };
}
