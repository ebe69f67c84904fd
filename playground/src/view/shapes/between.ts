// Traces shapes that go from one particle to another: taut and slack ropes, struts, coils.

import type { Shape } from '../../engine';
import { type Brush, ends } from '../brush';
import type { Vec3 } from '../camera';
import { traceSpring } from '../glyphs';
import type { Picture } from '../picture';

/** Turns of a spring's zig-zag. */
const COIL_TURNS = 6;

/** Slack, relative to the length, below which a rope counts as taut: half a pixel for a rope across the screen. */
const TAUT = 5e-4;

export function traceBetween(brush: Brush, shape: Shape): void {
  const [ax, ay, bx, by] = ends(brush, shape);
  brush.context.moveTo(ax, ay);
  brush.context.lineTo(bx, by);
}

/** The distance of the two particles of a shape, m. */
function distance(picture: Picture, { particles: [a, b] }: Shape): number {
  const { dimension } = picture.structure;
  let square = 0;
  for (let k = 0; k < dimension; k += 1)
    square += (picture.positions[dimension * a + k] - picture.positions[dimension * b + k]) ** 2;
  return Math.sqrt(square);
}

function isSlack(picture: Picture, shape: Shape): boolean {
  return shape.kind === 'rope' && distance(picture, shape) < shape.size * (1 - TAUT);
}

/** Whether the ends are farther apart than the size: a strut beyond its shortest length carries no force. */
export function isBeyond(picture: Picture, shape: Shape): boolean {
  return distance(picture, shape) > shape.size * (1 + TAUT);
}

export function traceTaut(brush: Brush, shape: Shape, picture: Picture): void {
  if (!isSlack(picture, shape)) traceBetween(brush, shape);
}

/**
 * A slack rope of length L hangs in a parabola between ends at a distance d. The sag of a flat parabola is
 * √(3 d (L − d)/8) and the sag of a folded rope is L/2; √(3 (L² − d²))/4 equals the first and is near the second.
 */
export function traceSlack(brush: Brush, shape: Shape, picture: Picture): void {
  if (!isSlack(picture, shape)) return;
  const { camera, context } = brush;
  const [ax, ay, bx, by] = ends(brush, shape);
  const d = distance(picture, shape);
  const sag = (Math.sqrt(3 * (shape.size ** 2 - d ** 2)) / 4) * camera.scale;
  const along = (axis: Vec3) => picture.down.reduce((sum, x, k) => sum + x * axis[k], 0);
  context.moveTo(ax, ay);
  // the middle of a quadratic curve lies halfway between the chord and the control point
  const [cx, cy] = [
    (ax + bx) / 2 + 2 * sag * along(camera.right),
    (ay + by) / 2 - 2 * sag * along(camera.up),
  ];
  context.quadraticCurveTo(cx, cy, bx, by);
}

export function traceCoil(brush: Brush, shape: Shape): void {
  const [ax, ay, bx, by] = ends(brush, shape);
  traceSpring(brush.context, ax, ay, bx, by, brush.sizes.coil, COIL_TURNS);
}
