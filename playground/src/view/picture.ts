// What one drawn frame needs. Plain data: the drawing reads it and keeps nothing.

import type { Mark, Structure } from '../engine';

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
  /** what holds the particles beside rods, nails and springs */
  marks: Mark[];
  /** the way things fall, a unit vector */
  down: number[];
  /** N, one per link */
  tension: Float64Array;
  /** places of the links that are broken */
  broken: Set<number>;
  /** N at the ends of the colour scale */
  tensionLimit: number;
  /** positions of the comparison run, or null */
  ghost: Float64Array | null;
  /** the comparison run came to its end */
  ghostStopped: boolean;
  selection: Selection;
  hover: Selection;
  mouse: { particle: number; target: number[] } | null;
  arrows: Arrow[];
}
