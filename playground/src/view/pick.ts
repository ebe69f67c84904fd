// Finds the particle or the link under a point of the screen.

import type { Structure } from '../engine';
import type { Selection } from './picture';

/** The nearest particle within reach, else the nearest link; x, y and reach in px. */
export function pick(
  structure: Structure,
  screen: Float64Array,
  radii: Float64Array,
  x: number,
  y: number,
  reach: number,
): Selection {
  let best: Selection = null;
  let nearest = reach;
  for (let i = 0; i < structure.masses.length; i += 1) {
    const away = Math.hypot(screen[3 * i] - x, screen[3 * i + 1] - y) - radii[i];
    if (away < nearest) [nearest, best] = [away, { kind: 'particle', index: i }];
  }
  if (best) return best;
  // a link has a smaller reach, so that a click beside it counts as empty canvas
  nearest = reach / 2;
  for (const [index, { particles }] of structure.links.entries()) {
    const away = distanceToSegment(x, y, screen, 3 * particles[0], 3 * particles[1]);
    if (away < nearest) [nearest, best] = [away, { kind: 'link', index }];
  }
  return best;
}

function distanceToSegment(x: number, y: number, flat: Float64Array, a: number, b: number): number {
  const [dx, dy] = [flat[b] - flat[a], flat[b + 1] - flat[a + 1]];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? ((x - flat[a]) * dx + (y - flat[a + 1]) * dy) / square : 0;
  const t = Math.max(0, Math.min(1, along));
  return Math.hypot(x - flat[a] - t * dx, y - flat[a + 1] - t * dy);
}
