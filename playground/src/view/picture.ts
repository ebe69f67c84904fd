// The data of one drawn frame. The layers only read it.

import type { Shape, Structure } from '../engine';
import type { Held } from '../session/hand';

export type Selection = { kind: 'particle'; index: number } | { kind: 'link'; index: number } | null;

export interface Arrow {
  particle: number;
  /** N, flat of one particle */
  force: number[];
  colour: 'ink' | 'accent';
  label: string;
}

export interface Picture {
  structure: Structure;
  positions: Float64Array;
  /** the engine's shapes without broken links */
  shapes: Shape[];
  /** the direction of gravity, a unit vector */
  down: number[];
  /** N, one for each link */
  tension: Float64Array;
  /** N at the ends of the colour scale */
  tensionLimit: number;
  /** positions of the comparison run, or null */
  ghost: Float64Array | null;
  /** whether the comparison run has stopped */
  ghostStopped: boolean;
  selection: Selection;
  hover: Selection;
  /** the particle that the hand pulls */
  held: Held | null;
  arrows: Arrow[];
}
