// The shapes of marks that go from one particle to another: taut and slack ropes, struts, coils.

import type { Mark } from '../engine';
import type { Vec3 } from './camera';
import { traceSpring } from './marks';
import { ends, type Pen } from './pen';

/** Within this part of its length a rope counts as taut: half a pixel of a rope across the screen. */
const TAUT = 5e-4;

export function traceBetween(pen: Pen, mark: Mark): void {
  const [ax, ay, bx, by] = ends(pen, mark);
  pen.context.moveTo(ax, ay);
  pen.context.lineTo(bx, by);
}

/** How far apart the two particles of a mark are, m. */
function distance({ picture }: Pen, { particles: [a, b] }: Mark): number {
  const { dimension } = picture.structure;
  let square = 0;
  for (let k = 0; k < dimension; k += 1)
    square += (picture.positions[dimension * a + k] - picture.positions[dimension * b + k]) ** 2;
  return Math.sqrt(square);
}

function isSlack(pen: Pen, mark: Mark): boolean {
  return mark.kind === 'rope' && distance(pen, mark) < mark.size * (1 - TAUT);
}

export function isBeyond(pen: Pen, mark: Mark): boolean {
  return distance(pen, mark) > mark.size * (1 + TAUT);
}

export function traceTaut(pen: Pen, mark: Mark): void {
  if (!isSlack(pen, mark)) traceBetween(pen, mark);
}

/**
 * A slack rope hangs in a parabola with about its length L: the sag f of a flat one over d is √(3 d (L − d)/8), of a folded
 * one L/2, and √(3 (L² − d²))/4 is the first and near the second.
 */
export function traceSlack(pen: Pen, mark: Mark): void {
  if (!isSlack(pen, mark)) return;
  const { camera, context, picture } = pen;
  const [ax, ay, bx, by] = ends(pen, mark);
  const d = distance(pen, mark);
  const sag = (Math.sqrt(3 * (mark.size ** 2 - d ** 2)) / 4) * camera.scale;
  const along = (axis: Vec3) => picture.down.reduce((sum, x, k) => sum + x * axis[k], 0);
  context.moveTo(ax, ay);
  // the middle of a quadratic curve is halfway to its control point
  const [cx, cy] = [
    (ax + bx) / 2 + 2 * sag * along(camera.right),
    (ay + by) / 2 - 2 * sag * along(camera.up),
  ];
  context.quadraticCurveTo(cx, cy, bx, by);
}

export function traceCoil(pen: Pen, mark: Mark): void {
  const [ax, ay, bx, by] = ends(pen, mark);
  traceSpring(pen.context, ax, ay, bx, by, 5, 6);
}
