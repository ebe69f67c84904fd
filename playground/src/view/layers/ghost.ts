// The ghost: the comparison run, dashed, below the scene itself.

import type { ShapeKind } from '../../engine';
import { type Brush, particlesOnScreen } from '../brush';
import { traceCircle, traceSegment } from '../glyphs';
import type { Picture } from '../picture';

/** The ghost is an outline: its rods, its springs and its particles. */
const SHOWN: readonly ShapeKind[] = ['rod', 'spring'];

export function drawGhost({ context, camera, palette, sizes }: Brush, picture: Picture): void {
  if (!picture.ghost) return;
  const screen = particlesOnScreen(camera, picture.ghost);
  context.strokeStyle = palette.ghost;
  context.globalAlpha = picture.ghostStopped ? 0.3 : 0.85;
  context.lineWidth = 2;
  context.setLineDash([5, 4]);
  context.beginPath();
  for (const { kind, particles } of picture.structure.shapes) {
    if (SHOWN.includes(kind)) traceSegment(context, screen, particles);
  }
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  for (const [i, radius] of sizes.radii.entries()) {
    traceCircle(context, screen[3 * i], screen[3 * i + 1], radius);
  }
  context.stroke();
  context.globalAlpha = 1;
}
