// The forces on the selected particle as arrows.

import type { Brush } from '../brush';
import { drawArrow } from '../glyphs';
import type { Picture } from '../picture';

/** Length of the arrow of the largest force, px. */
const LONGEST = 90;

export function drawArrows({ context, camera, palette, screen }: Brush, { arrows }: Picture): void {
  const largest = Math.max(...arrows.map(({ force }) => Math.hypot(...force)), 0);
  if (!(largest > 0)) return;
  context.font = 'italic 600 13px system-ui, sans-serif';
  context.lineWidth = 2;
  for (const { particle, force, colour, label } of arrows) {
    const along = (axis: readonly number[]) =>
      force.reduce((sum, component, k) => sum + component * axis[k], 0) * (LONGEST / largest);
    context.strokeStyle = palette[colour];
    context.fillStyle = palette[colour];
    const [dx, dy] = [along(camera.right), -along(camera.up)];
    drawArrow(context, screen[3 * particle], screen[3 * particle + 1], dx, dy, label);
  }
}
