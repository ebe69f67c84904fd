// The commands of the page, each in one record. The help lists the commands; the keyboard and the buttons run them.

import type { Page } from './page';
import { DEFAULT_SCENE } from './session/gallery';
import type { Selection } from './view/picture';

export interface Command {
  id: string;
  /** names of the keys that run it, as `KeyboardEvent.key` gives them; `Shift+` before an arrow with Shift */
  keys: readonly string[];
  /** the name of its button; a command without a button has none */
  label?(page: Page): string;
  /** the effect of its keys, for the help; '' for a command without keys */
  help: string;
  enabled(page: Page): boolean;
  /** `key` is the key that was pressed; for a button the first of the keys */
  run(page: Page, key: string): void;
  /** runs when the last of its keys is released */
  release?(page: Page): void;
}

const ARROWS = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'] as const;

/** Distance by which an arrow key moves the view or the hand that pulls, px. */
const STRIDE = 24;
/** Angle by which an arrow key turns a 3D view, rad. */
const TURN = 0.1;
/** Factor by which a key zooms. */
const ZOOM = 1.25;

const always = () => true;
const withScene = ({ session }: Page) => session.phase === 'ready';

/** The commands, in the order of the help. */
export const COMMANDS = [
  {
    id: 'play',
    keys: [' '],
    label: ({ playback }) => (playback.running ? 'Pause' : 'Play'),
    help: 'play or pause',
    enabled: (page) => withScene(page) && page.playback.stopped === null,
    run: ({ playback }) => playback.toggle(),
  },
  {
    id: 'step',
    keys: ['.'],
    label: () => 'One step',
    help: 'one step',
    enabled: withScene,
    run: ({ playback }) => playback.stepOnce(),
  },
  {
    id: 'reset',
    keys: ['r'],
    label: () => 'Reset',
    help: 'reset to the start',
    enabled: withScene,
    run: ({ playback }) => playback.reset(),
  },
  {
    id: 'speed',
    keys: ['<', '>'],
    help: 'slower, faster',
    enabled: always,
    run: ({ playback }, key) => playback.changeSpeed(key === '>' ? 1 : -1),
  },
  {
    id: 'particle',
    keys: ['[', ']'],
    help: 'previous, next particle',
    enabled: withScene,
    run: (page, key) => selectNext(page, 'particle', page.session.structure!.masses.length, key === ']'),
  },
  {
    id: 'link',
    keys: ['{', '}'],
    help: 'previous, next rod or rope',
    enabled: withScene,
    run: (page, key) => selectNext(page, 'link', page.session.structure!.links.length, key === '}'),
  },
  {
    id: 'pull',
    keys: ARROWS,
    help: 'pull the selected particle; with none selected, move the view',
    enabled: withScene,
    run: pullOrPan,
    release: ({ arrowHand }) => arrowHand.release(),
  },
  {
    id: 'turn',
    keys: ARROWS.map((arrow) => `Shift+${arrow}`),
    help: 'turn a 3D view',
    enabled: (page) => withScene(page) && page.session.structure?.dimension === 3,
    run: ({ stage }, key) => stage.orbit(...along(key, TURN)),
  },
  {
    id: 'zoom',
    // on many keyboards + is on the key of =, with Shift
    keys: ['+', '=', '-'],
    help: 'zoom',
    enabled: withScene,
    run: ({ stage }, key) => stage.zoom(key === '-' ? 1 / ZOOM : ZOOM),
  },
  { id: 'fit', keys: ['f'], help: 'fit the view', enabled: withScene, run: ({ stage }) => stage.fit() },
  {
    id: 'compare',
    keys: ['g'],
    label: () => 'Run a ghost beside the scene',
    help: 'compare with a ghost: a second run, by another method',
    enabled: withScene,
    run: ({ comparison }) => comparison.setOn(!comparison.on),
  },
  { id: 'terms', keys: ['t'], help: 'terms', enabled: always, run: ({ panels }) => panels.toggleTerms() },
  {
    id: 'theme',
    keys: ['l'],
    label: ({ theme }) => (theme.dark ? 'Light colours' : 'Dark colours'),
    help: 'light or dark',
    enabled: always,
    run: ({ theme }) => theme.toggle(),
  },
  {
    id: 'clear',
    keys: ['Escape'],
    label: () => 'Clear the selection',
    help: 'let go, clear the selection',
    enabled: always,
    run: clear,
  },
  {
    id: 'help',
    keys: ['?'],
    label: () => 'Hands and keys',
    help: 'these keys',
    enabled: always,
    run: ({ panels }) => {
      panels.help = !panels.help;
    },
  },
  {
    id: 'open-default',
    keys: [],
    label: () => 'Open a scene that works',
    help: '',
    enabled: always,
    run: ({ session }) => session.openNamed(DEFAULT_SCENE),
  },
] as const satisfies readonly Command[];

export type CommandId = (typeof COMMANDS)[number]['id'];

export function commandOf(id: CommandId): Command {
  return COMMANDS.find((command) => command.id === id)!;
}

/** The names in the help of keys whose `KeyboardEvent.key` is not their usual name. */
const KEY_NAMES: Record<string, string> = { ' ': 'Space', Escape: 'Esc', '-': '−' };

/** The keys of a command as the help shows them, in one text. */
export function keysInWords({ keys }: Pick<Command, 'keys'>): string {
  if (keys.includes('ArrowLeft')) return 'Arrows';
  if (keys.includes('Shift+ArrowLeft')) return 'Shift + arrows';
  return keys
    .filter((key) => key !== '=')
    .map((key) => KEY_NAMES[key] ?? key)
    .join(' ');
}

/** Screen x and y of one press of an arrow key. */
function along(key: string, size: number): [number, number] {
  if (key.endsWith('ArrowLeft')) return [-size, 0];
  if (key.endsWith('ArrowRight')) return [size, 0];
  return key.endsWith('ArrowUp') ? [0, -size] : [0, size];
}

function selectNext({ readings }: Page, kind: 'particle' | 'link', count: number, forward: boolean): void {
  if (count === 0) return;
  const { selection } = readings;
  const by = forward ? 1 : -1;
  const index = selection?.kind === kind ? selection.index + by : forward ? 0 : count - 1;
  readings.select({ kind, index: (index + count) % count } as Selection);
}

function pullOrPan({ session, readings, stage, arrowHand }: Page, key: string): void {
  const [dx, dy] = along(key, STRIDE);
  const { selection } = readings;
  if (selection?.kind === 'particle' && !session.structure?.fixed[selection.index]) {
    arrowHand.move(selection.index, dx, dy);
  } else stage.pan(-dx, -dy);
}

function clear({ readings, arrowHand }: Page): void {
  arrowHand.release();
  readings.select(null);
  if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
}
