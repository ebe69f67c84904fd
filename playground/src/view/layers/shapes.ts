// The engine's shapes: whatever holds or pushes particles. One path a style keeps scenes with many shapes fast.

import type { Brush } from '../brush';
import type { Picture } from '../picture';
import { STYLES } from '../shapes/styles';

export function drawShapes(brush: Brush, picture: Picture): void {
  if (picture.shapes.length === 0) return;
  const { context, palette } = brush;
  context.lineCap = 'round';
  context.lineJoin = 'round';
  for (const { kinds, colour, width, dash, fill, trace } of STYLES) {
    const shapes = picture.shapes.filter(({ kind }) => kinds.includes(kind));
    if (shapes.length === 0) continue;
    context.beginPath();
    for (const shape of shapes) trace(brush, shape, picture);
    if (fill) {
      context.fillStyle = palette[colour];
      context.globalAlpha = fill;
      context.fill();
      context.globalAlpha = 1;
    }
    if (width === 0) continue;
    context.strokeStyle = palette[colour];
    context.lineWidth = width;
    context.setLineDash(dash ? [...dash] : []);
    context.stroke();
  }
  context.setLineDash([]);
}
