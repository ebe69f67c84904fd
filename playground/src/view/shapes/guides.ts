// Traces shapes that lead particles: wires, endless lines, rings, angles.

import type { Shape } from '../../engine';
import { type Brush, ends, project } from '../brush';
import type { Vec3 } from '../camera';
import { traceRing } from './solids';

const ANGLE_RADIUS = 24;
/** Length by which the line for the direction of an angle extends beyond the arc, px. */
const REFERENCE = 10;

/** A guide of a bead: a wire, an endless line or a ring. */
export function traceGuide(brush: Brush, shape: Shape): void {
  const { context, camera } = brush;
  if (shape.kind === 'ring') traceRing(brush, shape);
  else if (shape.kind === 'line') traceLine(brush, shape);
  else {
    for (let i = 0; 3 * i < shape.points.length; i += 1) {
      const [x, y] = project(camera, shape.points, i);
      if (i === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
  }
}

/** A line across the whole canvas in every view. */
function traceLine(brush: Brush, shape: Shape): void {
  const { context, camera } = brush;
  let [ax, ay, bx, by] = ends(brush, shape);
  if (shape.particles.length < 2) {
    const [ox, oy] = project(camera, [0, 0, 0], 0);
    // the last point is a direction: the difference of two points on the screen, of which one is the origin
    [bx, by] = [ax + bx - ox, ay + by - oy];
  }
  const length = Math.hypot(bx - ax, by - ay);
  if (length < 1e-9) return;
  const [ux, uy] = [(bx - ax) / length, (by - ay) / length];
  const [mx, my] = camera.middle;
  const nearest = (mx - ax) * ux + (my - ay) * uy;
  const reach = camera.width + camera.height;
  context.moveTo(ax + (nearest - reach) * ux, ay + (nearest - reach) * uy);
  context.lineTo(ax + (nearest + reach) * ux, ay + (nearest + reach) * uy);
}

/** An arc at the corner from the first arm, or from the direction, to the second arm, over at most half a turn. */
export function traceAngle({ context, camera, screen }: Brush, { particles, points }: Shape): void {
  const arm = (a: number, b: number) =>
    Math.atan2(screen[3 * b + 1] - screen[3 * a + 1], screen[3 * b] - screen[3 * a]);
  const [c, d] = particles.slice(-2);
  const [x, y] = [screen[3 * c], screen[3 * c + 1]];
  const along = (axis: Vec3) => axis.reduce((sum, part, k) => sum + part * (points[k] ?? 0), 0);
  const from =
    particles.length === 4
      ? arm(particles[0], particles[1])
      : Math.atan2(-along(camera.up), along(camera.right));
  const turn = arm(c, d) - from;
  const shorter = turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  // a line shows the direction from which the angle counts where no arm lies along it
  if (particles.length < 4 || particles[0] !== c) {
    context.moveTo(x, y);
    const far = ANGLE_RADIUS + REFERENCE;
    context.lineTo(x + far * Math.cos(from), y + far * Math.sin(from));
  }
  context.moveTo(x + ANGLE_RADIUS * Math.cos(from), y + ANGLE_RADIUS * Math.sin(from));
  context.arc(x, y, ANGLE_RADIUS, from, from + shorter, shorter < 0);
}
