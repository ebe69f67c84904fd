// The ghost: the comparison run, dashed, below the scene itself.

import { isRod } from '../../session/links';
import { type Brush, particlesOnScreen } from '../brush';
import { traceCircle, traceSegment } from '../glyphs';
import type { Picture } from '../picture';

export function drawGhost({ context, camera, palette, sizes }: Brush, picture: Picture): void {
  if (!picture.ghost) return;
  const { links, springs } = picture.structure;
  const screen = particlesOnScreen(camera, picture.ghost);
  context.strokeStyle = palette.ghost;
  context.globalAlpha = picture.ghostStopped ? 0.3 : 0.85;
  context.lineWidth = 2;
  context.setLineDash([5, 4]);
  context.beginPath();
  for (const link of links) if (isRod(link)) traceSegment(context, screen, link);
  for (const spring of springs) traceSegment(context, screen, spring);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  for (const [i, radius] of sizes.radii.entries()) {
    traceCircle(context, screen[3 * i], screen[3 * i + 1], radius);
  }
  context.stroke();
  context.globalAlpha = 1;
}
