// The mouse spring, from the particle that is pulled to the hand.

import type { Brush } from '../brush';
import { traceCircle, traceSpring } from '../glyphs';
import type { Picture } from '../picture';

/** Radius of the ring at the hand, px. */
const RADIUS = 7;

export function drawHand({ context, camera, palette, screen }: Brush, { held }: Picture): void {
  if (!held) return;
  const at = [0, 0, 0];
  camera.project(held.target, 0, at);
  const i = held.particle;
  context.strokeStyle = palette.accent;
  context.lineWidth = 2;
  context.lineJoin = 'round';
  context.beginPath();
  traceSpring(context, screen[3 * i], screen[3 * i + 1], at[0], at[1], 4, 7);
  traceCircle(context, at[0], at[1], RADIUS);
  context.stroke();
}
