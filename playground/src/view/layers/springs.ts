// Springs, as zig-zags.

import type { Brush } from '../brush';
import { traceSpring } from '../glyphs';
import type { Picture } from '../picture';

export function drawSprings({ context, palette, screen }: Brush, { structure: { springs } }: Picture): void {
  if (springs.length === 0) return;
  const width = springs.length > 60 ? 3 : 5;
  context.strokeStyle = palette.spring;
  context.lineWidth = 1.5;
  context.lineJoin = 'round';
  context.beginPath();
  for (const { a, b } of springs) {
    traceSpring(context, screen[3 * a], screen[3 * a + 1], screen[3 * b], screen[3 * b + 1], width, 6);
  }
  context.stroke();
}
