// The parts of the running page. App.svelte makes them; commands, keyboard and the console's handle act on them.

import type { Panels } from './panels/panels.svelte';
import type { Comparison } from './session/comparison.svelte';
import type { Hand } from './session/hand';
import type { Playback } from './session/playback.svelte';
import type { Readings } from './session/readings.svelte';
import type { Session } from './session/session.svelte';
import type { Theme } from './theme.svelte';
import type { ArrowHand } from './view/arrow-hand';
import type { Stage } from './view/stage';

export interface Page {
  session: Session;
  comparison: Comparison;
  hand: Hand;
  playback: Playback;
  readings: Readings;
  theme: Theme;
  panels: Panels;
  /** there once the canvas is */
  stage: Stage;
  arrowHand: ArrowHand;
}
