// Links in words: what a person calls one, and how long it may be.

import type { Link } from '../engine';
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
