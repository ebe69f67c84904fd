// The engine's shapes behind links and particles. One path for each style keeps scenes with many shapes fast.

import type { Shape, ShapeKind } from '../../engine';
import type { Brush } from '../brush';
import type { Picture } from '../picture';
import { STYLES } from '../shapes/styles';

export function drawShapes(brush: Brush, picture: Picture): void {
  if (picture.shapes.length === 0) return;
  const { context, palette } = brush;
  context.lineCap = 'round';
  context.lineJoin = 'round';
  const byKind = shapesByKind(picture.shapes);
  for (const { kinds, colour, width, dash, fill, trace } of STYLES) {
    const shapes = kinds.flatMap((kind) => byKind.get(kind) ?? []);
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

function shapesByKind(shapes: readonly Shape[]): Map<ShapeKind, Shape[]> {
  const byKind = new Map<ShapeKind, Shape[]>();
  for (const shape of shapes) {
    const same = byKind.get(shape.kind);
    if (same) same.push(shape);
    else byKind.set(shape.kind, [shape]);
  }
  return byKind;
}
