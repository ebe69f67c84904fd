// The quiet background: a metre grid in 2D, three axes in 3D, and a scale bar that says how long a metre is.

import { format, niceCeiling } from '../session/numbers';
import type { Camera } from './camera';
import type { Palette } from './palette';

/** Grid lines come about this far apart, px. */
const SPACING = 90;

export function drawGrid(context: CanvasRenderingContext2D, camera: Camera, palette: Palette): void {
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

/** A bar of a round number of metres at the lower left of the free canvas; the axes above it in 3D. */
export function drawScale(context: CanvasRenderingContext2D, camera: Camera, palette: Palette): void {
  const metres = niceCeiling(SPACING / camera.scale / 2.5);
  const length = metres * camera.scale;
  const x = camera.inset.left + 20;
  const y = camera.height - camera.inset.bottom - 20;
  context.strokeStyle = palette.muted;
  context.fillStyle = palette.muted;
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(x, y - 4);
  context.lineTo(x, y);
  context.lineTo(x + length, y);
  context.lineTo(x + length, y - 4);
  context.stroke();
  context.font = '11px system-ui, sans-serif';
  context.textAlign = 'left';
  context.textBaseline = 'bottom';
  context.fillText(`${format(metres)} m`, x + 6, y - 4);
  if (camera.dimension === 3) drawAxes(context, camera, x + 22, y - 52);
}

function drawAxes(context: CanvasRenderingContext2D, camera: Camera, x: number, y: number): void {
  const length = 24;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (const [k, name] of ['x', 'y', 'z'].entries()) {
    const [dx, dy] = [camera.right[k] * length, -camera.up[k] * length];
    context.globalAlpha = camera.towards[k] < -0.05 ? 0.45 : 1;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + dx, y + dy);
    context.stroke();
    context.fillText(name, x + dx * 1.4, y + dy * 1.4);
  }
  context.globalAlpha = 1;
}
