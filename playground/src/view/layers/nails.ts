// Nails that stay where they are.

import type { Brush } from '../brush';
import { traceNail } from '../glyphs';
import type { Picture } from '../picture';

export function drawNails(
  { context, camera, palette, sizes }: Brush,
  { structure: { nails } }: Picture,
): void {
  if (nails.length === 0) return;
  const at = [0, 0, 0];
  context.strokeStyle = palette.ink;
  context.lineWidth = 1.5;
  context.beginPath();
  for (const nail of nails) {
    camera.project(nail.at, 0, at);
    traceNail(context, at[0], at[1], sizes.radii[nail.particle] + 4);
  }
  context.stroke();
}
