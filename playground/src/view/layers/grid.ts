// The grid of round numbers of metres behind a scene in the plane.

import { niceCeiling } from '../../session/numbers';
import type { Brush } from '../brush';

/** Approximate distance of grid lines, px. */
export const SPACING = 90;

export function drawGrid({ context, camera, palette }: Brush): void {
  if (camera.dimension === 3) return;
  const step = niceCeiling(SPACING / camera.scale);
  const [left, top] = camera.unproject(0, 0, [0, 0]);
  const [right, bottom] = camera.unproject(camera.width, camera.height, [0, 0]);
  const [mx, my] = camera.middle;
  context.beginPath();
  for (let k = Math.ceil(left / step); k * step <= right; k += 1) {
    const x = Math.round(mx + (k * step - camera.centre[0]) * camera.scale) + 0.5;
    context.moveTo(x, 0);
    context.lineTo(x, camera.height);
  }
  for (let k = Math.ceil(bottom / step); k * step <= top; k += 1) {
    const y = Math.round(my - (k * step - camera.centre[1]) * camera.scale) + 0.5;
    context.moveTo(0, y);
    context.lineTo(camera.width, y);
  }
  context.strokeStyle = palette.grid;
  context.lineWidth = 1;
  context.stroke();
}
