// Traces shapes that are more than a line: ground, planes, balls, boxes, rings, wheels, areas, a piston.

import type { Shape } from '../../engine';
import { niceCeiling } from '../../session/numbers';
import { type Brush, ends, project } from '../brush';
import type { Vec3 } from '../camera';
import { traceCircle } from '../glyphs';

/** Distance and depth of the strokes of a hatch, px. */
const HATCH = 12;
/** Approximate distance of the lines in a plane, px, and their number to each side. */
const PLANE_CELL = 60;
const PLANE_CELLS = 8;
/** Number of straight pieces of a ring: on a screen of a thousand pixels they are within a pixel of the ring. */
const RING_PIECES = 96;

/** In the plane, ground is a line across the canvas with a hatch below; in space it is a plane. */
export function traceGround(brush: Brush, shape: Shape): void {
  const { context, camera } = brush;
  if (camera.dimension === 3) return;
  const [x, y] = project(camera, shape.points, 0);
  // the screen's y points down
  const [nx, ny] = [shape.points[3], -shape.points[4]];
  const [ux, uy] = [-ny, nx];
  const [mx, my] = camera.middle;
  const reach = camera.width + camera.height;
  const nearest = (mx - x) * ux + (my - y) * uy;
  context.moveTo(x + (nearest - reach) * ux, y + (nearest - reach) * uy);
  context.lineTo(x + (nearest + reach) * ux, y + (nearest + reach) * uy);
  const first = Math.ceil((nearest - reach) / HATCH);
  const last = Math.floor((nearest + reach) / HATCH);
  // counted from a point of the ground, so that the hatch moves with the view
  for (let k = first; k <= last; k += 1) {
    const [px, py] = [x + k * HATCH * ux, y + k * HATCH * uy];
    context.moveTo(px, py);
    context.lineTo(px - HATCH * (nx - 0.7 * ux), py - HATCH * (ny - 0.7 * uy));
  }
}

/** A grid in a plane, around its point nearest to the middle of the view. */
export function tracePlane({ context, camera }: Brush, { points }: Shape): void {
  if (camera.dimension === 2) return;
  const point = [points[0], points[1], points[2]];
  const [n, u, v] = frame([points[3], points[4], points[5]]);
  const cell = niceCeiling(PLANE_CELL / camera.scale);
  const away = camera.centre.map((x, k) => x - point[k]);
  // a whole number of cells from the plane's own point, so that the lines are fixed in the scene
  const [i, j] = [u, v].map((axis) => Math.round(dot(away, axis) / cell));
  const at = (a: number, b: number) =>
    project(
      camera,
      point.map((x, k) => x + (i + a) * cell * u[k] + (j + b) * cell * v[k]),
      0,
    );
  if (Math.abs(dot(camera.towards, n)) < 1e-3) return;
  const half = PLANE_CELLS / 2;
  for (let k = -half; k <= half; k += 1) {
    context.moveTo(...at(k, -half));
    context.lineTo(...at(k, half));
    context.moveTo(...at(-half, k));
    context.lineTo(...at(half, k));
  }
}

export function traceRing(brush: Brush, shape: Shape): void {
  traceAround(brush, shape, Array.from(shape.points.subarray(shape.points.length - 3)));
}

/** The circles of a ball across the three axes: without them a ball in space looks like a disc. */
export function traceGreatCircles(brush: Brush, shape: Shape): void {
  if (brush.camera.dimension === 2) return;
  for (const k of [0, 1, 2]) {
    traceAround(
      brush,
      shape,
      [0, 1, 2].map((j) => (j === k ? 1 : 0)),
    );
  }
}

/** A circle about the first end of a shape, at right angles to an axis. */
function traceAround(brush: Brush, shape: Shape, axis: number[]): void {
  const { context, camera } = brush;
  const [x, y] = ends(brush, shape);
  const [, u, v] = frame(axis);
  const radius = shape.size * camera.scale;
  const reach = (to: Vec3, along: Vec3) => radius * dot(to, along);
  for (let i = 0; i < RING_PIECES; i += 1) {
    const [c, s] = [Math.cos((2 * Math.PI * i) / RING_PIECES), Math.sin((2 * Math.PI * i) / RING_PIECES)];
    const px = x + c * reach(u, camera.right) + s * reach(v, camera.right);
    const py = y - c * reach(u, camera.up) - s * reach(v, camera.up);
    if (i === 0) context.moveTo(px, py);
    else context.lineTo(px, py);
  }
  context.closePath();
}

/** The thick half of a piston, from its first end to the middle. */
export function traceActuator(brush: Brush, shape: Shape): void {
  const [ax, ay, bx, by] = ends(brush, shape);
  brush.context.moveTo(ax, ay);
  brush.context.lineTo((ax + bx) / 2, (ay + by) / 2);
}

export function traceArea({ context, screen }: Brush, { particles }: Shape): void {
  for (const [i, particle] of particles.entries()) {
    const [x, y] = [screen[3 * particle], screen[3 * particle + 1]];
    if (i === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
  context.closePath();
}

export function traceBall(brush: Brush, shape: Shape): void {
  const [x, y] = ends(brush, shape);
  traceCircle(brush.context, x, y, shape.size * brush.camera.scale);
}

/** A rectangle, or in space the visible faces of a box: faces do not overlap, so that all have the same opacity. */
export function traceBox({ context, camera }: Brush, { points }: Shape): void {
  for (const axis of camera.dimension === 2 ? [2] : [0, 1, 2]) {
    const side = Math.sign(camera.towards[axis]);
    if (side === 0) continue;
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    // every face goes the same way round on the screen, so that overlapping faces of two boxes do not cancel
    for (const [n, [a, b]] of [
      [-1, -1],
      [side, -side],
      [1, 1],
      [-side, side],
    ].entries()) {
      const corner = [points[0], points[1], points[2]];
      corner[axis] += camera.dimension === 2 ? 0 : side * points[3 + axis];
      corner[u] += a * points[3 + u];
      corner[v] += b * points[3 + v];
      const [x, y] = project(camera, corner, 0);
      if (n === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
    context.closePath();
  }
}

export function traceWheel(brush: Brush, shape: Shape): void {
  const [x, y, rimX, rimY] = ends(brush, shape);
  const radius = shape.size * brush.camera.scale;
  traceCircle(brush.context, x, y, radius);
  const angle = Math.atan2(rimY - y, rimX - x);
  brush.context.moveTo(x, y);
  brush.context.lineTo(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
}

/** The unit vector of a direction, and two unit vectors at right angles to it and to each other. */
function frame(direction: number[]): [Vec3, Vec3, Vec3] {
  const n = unit(direction);
  const least = [0, 1, 2].reduce((best, k) => (Math.abs(n[k]) < Math.abs(n[best]) ? k : best), 0);
  const u = unit(
    cross(
      [0, 1, 2].map((k) => (k === least ? 1 : 0)),
      n,
    ),
  );
  return [n, u, cross(n, u)];
}

function dot(a: ArrayLike<number>, b: ArrayLike<number>): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: ArrayLike<number>, b: ArrayLike<number>): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(a: ArrayLike<number>): Vec3 {
  const size = Math.hypot(a[0], a[1], a[2]);
  return [a[0] / size, a[1] / size, a[2] / size];
}
