// Rods, ropes and struts: their lengths in words, and the shapes that are left when links break.

import type { Link, LinkShape, Shape } from '../engine';
import { format } from './numbers';

/** A rod has one length; ropes and struts have limits. */
export function isRod({ kind }: LinkShape): boolean {
  return kind === 'rod';
}

export function lengthsOf({ shortest, longest }: Link): string {
  if (shortest === longest) return `${format(longest!)} m`;
  if (shortest === null) return `at most ${format(longest!)} m`;
  if (longest === null) return `at least ${format(shortest)} m`;
  return `${format(shortest)} m to ${format(longest)} m`;
}

/** The shapes without the broken links; `broken` has the places of these links. */
export function unbroken(shapes: Shape[], broken: ReadonlySet<number>): Shape[] {
  if (broken.size === 0) return shapes;
  return shapes.filter(({ link }) => link === null || !broken.has(link.place));
}
