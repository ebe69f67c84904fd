// The scale bar at the lower left, which shows the length of a metre, and in 3D the three axes above it.

import { format, niceCeiling } from '../../session/numbers';
import type { Brush } from '../brush';
import type { Camera } from '../camera';
import { SPACING } from './grid';

/** A bar of a round number of metres at the lower left of the free canvas; the axes above it in 3D. */
export function drawScale({ context, camera, palette }: Brush): void {
  const metres = niceCeiling(SPACING / camera.scale / 2.5);
  const length = metres * camera.scale;
  const x = camera.inset.left + 20;
  const y = camera.height - camera.inset.bottom - 20;
  context.strokeStyle = palette.outline;
  context.fillStyle = palette.outline;
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
