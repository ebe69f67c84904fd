// Links in words: what a person calls one, and how long it may be.

import type { Link, Mark } from '../engine';
import { format } from './numbers';

/** It holds one length. */
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

/** The marks that are left when the links at these places are broken. */
export function unbroken(marks: Mark[], links: readonly Link[], broken: ReadonlySet<number>): Mark[] {
  if (broken.size === 0) return marks;
  const gone = new Set([...broken].map((place) => `${links[place].a} ${links[place].b}`));
  const isLink = ({ kind }: Mark) => kind === 'rope' || kind === 'strut';
  return marks.filter((mark) => !isLink(mark) || !gone.has(mark.particles.join(' ')));
}
