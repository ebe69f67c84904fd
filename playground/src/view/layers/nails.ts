// Nails, in front of links and behind their particles.

import { type Brush, project } from '../brush';
import { traceNail } from '../glyphs';
import type { Picture } from '../picture';

/** Width by which the ring of a nail extends beyond its particle, px. */
const GAP = 4;

export function drawNails({ context, camera, palette, sizes }: Brush, { shapes }: Picture): void {
  const nails = shapes.filter(({ kind }) => kind === 'nail');
  if (nails.length === 0) return;
  context.strokeStyle = palette.ink;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const { particles, points } of nails) {
    traceNail(context, ...project(camera, points, 0), sizes.radii[particles[0]] + GAP);
  }
  context.stroke();
}
