// The brush that draws every layer and every shape; it also projects points to the screen.

import type { Shape } from '../engine';
import type { Camera } from './camera';
import type { Palette } from './palette';
import type { Picture } from './picture';
import type { Sizes } from './sizes';

export interface Brush {
  context: CanvasRenderingContext2D;
  camera: Camera;
  palette: Palette;
  sizes: Sizes;
  /** screen x and y in px and depth in m of every particle of the state shown */
  screen: Float64Array;
}

/** Draws one layer of a picture; the layers of a picture are listed in canvas.ts. */
export type Layer = (brush: Brush, picture: Picture) => void;

/** Screen x and y in px and depth in m of every particle. */
export function particlesOnScreen(camera: Camera, positions: Float64Array): Float64Array {
  const count = positions.length / camera.dimension;
  const screen = new Float64Array(3 * count);
  const at = [0, 0, 0];
  for (let i = 0; i < count; i += 1) {
    camera.project(positions, i, at);
    screen.set(at, 3 * i);
  }
  return screen;
}

/** Screen x and y in px of point i of a shape. */
export function project(camera: Camera, points: ArrayLike<number>, i: number): [number, number] {
  const out = [0, 0, 0];
  camera.project(points, i, out, 3);
  return [out[0], out[1]];
}

/** The two ends of a shape on the screen: its particles first, then its points. */
export function ends(
  { screen, camera }: Pick<Brush, 'screen' | 'camera'>,
  { particles, points }: Shape,
): [number, number, number, number] {
  const [a, b] = particles;
  const from: [number, number] =
    a === undefined ? project(camera, points, 0) : [screen[3 * a], screen[3 * a + 1]];
  const to: [number, number] =
    b === undefined ? project(camera, points, a === undefined ? 1 : 0) : [screen[3 * b], screen[3 * b + 1]];
  return [...from, ...to];
}
