// The gallery: which scene comes first, and the shipped scenes under their headings.

import type { Shipped } from '../engine';

/** The scene of a visitor who names none: it moves at once and invites a pull. */
export const DEFAULT_SCENE = 'strandbeest';

/** The scenes under their headings, both in the order in which they first come. */
export function grouped(scenes: readonly Shipped[]): { heading: string; scenes: Shipped[] }[] {
  const headings = new Map<string, Shipped[]>();
  for (const scene of scenes) headings.set(scene.group, [...(headings.get(scene.group) ?? []), scene]);
  return Array.from(headings, ([heading, members]) => ({ heading, scenes: members }));
}
