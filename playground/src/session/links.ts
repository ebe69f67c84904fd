// Links in words: their common names and their lengths.

import type { Link, Shape } from '../engine';
import { format } from './numbers';

/** A rod has one length; ropes and struts have limits. */
export function isRod({ shortest, longest }: Link): boolean {
  return shortest === longest;
}

export function nameOf(link: Link): 'rod' | 'rope' | 'strut' {
  if (isRod(link)) return 'rod';
  return link.shortest === null ? 'rope' : 'strut';
}

export function lengthsOf({ shortest, longest }: Link): string {
  if (shortest === longest) return `${format(longest!)} m`;
  if (shortest === null) return `at most ${format(longest!)} m`;
  if (longest === null) return `at least ${format(shortest)} m`;
  return `${format(shortest)} m to ${format(longest)} m`;
}

/** The shapes without those of the broken links; `broken` has the places of these links. */
export function unbroken(shapes: Shape[], links: readonly Link[], broken: ReadonlySet<number>): Shape[] {
  if (broken.size === 0) return shapes;
  const gone = new Set([...broken].map((place) => `${links[place].a} ${links[place].b}`));
  const isLink = ({ kind }: Shape) => kind === 'rope' || kind === 'strut';
  return shapes.filter((shape) => !isLink(shape) || !gone.has(shape.particles.join(' ')));
}
