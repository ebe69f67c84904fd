// The gallery: the first scene, and the shipped scenes under their headings.

import type { Shipped } from '../engine';

/** The scene that opens if the address names none: it moves at once, and its particles can be pulled. */
export const DEFAULT_SCENE = 'strandbeest';

/** The scenes under their headings, both in the order of the list. */
export function grouped(scenes: readonly Shipped[]): { heading: string; scenes: Shipped[] }[] {
  const headings = new Map<string, Shipped[]>();
  for (const scene of scenes) headings.set(scene.group, [...(headings.get(scene.group) ?? []), scene]);
  return Array.from(headings, ([heading, members]) => ({ heading, scenes: members }));
}
