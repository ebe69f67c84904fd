// What the shapes of marks are traced with, and where their particles and points are on the screen.

import type { Mark } from '../engine';
import type { Camera } from './camera';
import type { Picture } from './picture';

/** What a shape is traced with. */
export interface Pen {
  context: CanvasRenderingContext2D;
  camera: Camera;
  /** screen x, y and depth of every particle */
  screen: Float64Array;
  picture: Picture;
}

/** Where a point of a mark is on the screen, px. */
export function project(camera: Camera, points: ArrayLike<number>, i: number): [number, number] {
  const out = [0, 0, 0];
  camera.project(points, i, out, 3);
  return [out[0], out[1]];
}

/** The two ends of a mark on the screen: particles first, then points. */
export function ends({ screen, camera }: Pen, { particles, points }: Mark): [number, number, number, number] {
  const [a, b] = particles;
  const from: [number, number] =
    a === undefined ? project(camera, points, 0) : [screen[3 * a], screen[3 * a + 1]];
  const to: [number, number] =
    b === undefined ? project(camera, points, a === undefined ? 1 : 0) : [screen[3 * b], screen[3 * b + 1]];
  return [...from, ...to];
}
