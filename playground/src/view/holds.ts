// Draws the engine's marks: what holds particles and is no rod, nail or spring. One path a style, back to front in the order of STYLES.

import type { Mark, MarkKind } from '../engine';
import type { Camera, Vec3 } from './camera';
import { traceActuator, traceGround, tracePlane, traceRing } from './hold-shapes';
import { traceNail, traceSpring } from './marks';
import type { Palette } from './palette';
import { ends, type Pen, project } from './pen';
import type { Picture } from './picture';

/** Within this part of its length a rope counts as taut: half a pixel of a rope across the screen. */
const TAUT = 5e-4;
const ANGLE_RADIUS = 24;
/** How far the direction from which an angle counts goes beyond the arc, px. */
const REFERENCE = 10;

interface Style {
  kinds: readonly MarkKind[];
  colour: 'ink' | 'muted' | 'guide' | 'background' | 'accent' | 'spring';
  width: number;
  dash?: readonly number[];
  /** how much of the colour the inside gets */
  fill?: number;
  trace(pen: Pen, mark: Mark): void;
}

const STYLES: readonly Style[] = [
  { kinds: ['area'], colour: 'accent', width: 0, fill: 0.14, trace: traceArea },
  { kinds: ['ground'], colour: 'muted', width: 1.25, trace: traceGround },
  { kinds: ['plane'], colour: 'guide', width: 1, trace: tracePlane },
  { kinds: ['ball'], colour: 'muted', width: 1.5, fill: 0.16, trace: traceBall },
  { kinds: ['bowl'], colour: 'muted', width: 1.5, trace: traceBall },
  { kinds: ['box'], colour: 'muted', width: 1.5, fill: 0.16, trace: traceBox },
  { kinds: ['wheel'], colour: 'muted', width: 2, fill: 0.12, trace: traceWheel },
  { kinds: ['wire', 'line', 'ring'], colour: 'guide', width: 5, trace: traceGuide },
  { kinds: ['wire', 'line', 'ring'], colour: 'background', width: 2, trace: traceGuide },
  { kinds: ['tie'], colour: 'muted', width: 1.5, dash: [1.5, 5], trace: traceBetween },
  { kinds: ['rope'], colour: 'ink', width: 1.25, dash: [4, 4], trace: traceSlack },
  { kinds: ['cord', 'rope'], colour: 'ink', width: 1.75, trace: traceTaut },
  {
    kinds: ['strut'],
    colour: 'muted',
    width: 4,
    trace: (pen, mark) => isBeyond(pen, mark) || traceBetween(pen, mark),
  },
  {
    kinds: ['strut'],
    colour: 'muted',
    width: 2,
    dash: [6, 5],
    trace: (pen, mark) => isBeyond(pen, mark) && traceBetween(pen, mark),
  },
  { kinds: ['spring'], colour: 'spring', width: 1.5, trace: traceCoil },
  { kinds: ['rod', 'actuator'], colour: 'muted', width: 2.5, trace: traceBetween },
  { kinds: ['rod', 'actuator'], colour: 'muted', width: 7, trace: traceActuator },
  { kinds: ['angle'], colour: 'accent', width: 2, trace: traceAngle },
  {
    kinds: ['nail'],
    colour: 'ink',
    width: 1.5,
    trace: ({ context, camera }, mark) => traceNail(context, ...project(camera, mark.points, 0), 9),
  },
];

export function drawHolds(
  context: CanvasRenderingContext2D,
  picture: Picture,
  screen: Float64Array,
  camera: Camera,
  palette: Palette,
): void {
  if (picture.marks.length === 0) return;
  const pen: Pen = { context, camera, screen, picture };
  context.lineCap = 'round';
  context.lineJoin = 'round';
  for (const { kinds, colour, width, dash, fill, trace } of STYLES) {
    if (!picture.marks.some(({ kind }) => kinds.includes(kind))) continue;
    context.beginPath();
    for (const mark of picture.marks) if (kinds.includes(mark.kind)) trace(pen, mark);
    if (fill) {
      context.fillStyle = palette[colour];
      context.globalAlpha = fill;
      context.fill();
      context.globalAlpha = 1;
    }
    if (width === 0) continue;
    context.strokeStyle = palette[colour];
    context.lineWidth = width;
    context.setLineDash(dash ? [...dash] : []);
    context.stroke();
  }
  context.setLineDash([]);
}

function traceBetween(pen: Pen, mark: Mark): void {
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

function isBeyond(pen: Pen, mark: Mark): boolean {
  return distance(pen, mark) > mark.size * (1 + TAUT);
}

function traceTaut(pen: Pen, mark: Mark): void {
  if (!isSlack(pen, mark)) traceBetween(pen, mark);
}

/**
 * A slack rope hangs in a parabola with about its length L: the sag f of a flat one over d is √(3 d (L − d)/8), of a folded
 * one L/2, and √(3 (L² − d²))/4 is the first and near the second.
 */
function traceSlack(pen: Pen, mark: Mark): void {
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

function traceCoil(pen: Pen, mark: Mark): void {
  const [ax, ay, bx, by] = ends(pen, mark);
  traceSpring(pen.context, ax, ay, bx, by, 5, 6);
}

function traceArea({ context, screen }: Pen, { particles }: Mark): void {
  for (const [i, particle] of particles.entries()) {
    const [x, y] = [screen[3 * particle], screen[3 * particle + 1]];
    if (i === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  }
  context.closePath();
}

function traceCircle(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.moveTo(x + radius, y);
  context.arc(x, y, radius, 0, 2 * Math.PI);
}

function traceBall(pen: Pen, mark: Mark): void {
  const [x, y] = ends(pen, mark);
  traceCircle(pen.context, x, y, mark.size * pen.camera.scale);
}

/** The rectangle, or the twelve edges in space. */
function traceBox({ context, camera }: Pen, { points }: Mark): void {
  const corner = (i: number) =>
    project(
      camera,
      [0, 1, 2].map((k) => points[k] + ((i >> k) & 1 ? 1 : -1) * points[3 + k]),
      0,
    );
  const loops =
    camera.dimension === 2
      ? [[0, 1, 3, 2]]
      : [
          [0, 1, 3, 2],
          [4, 5, 7, 6],
          [0, 1, 5, 4],
          [2, 3, 7, 6],
        ];
  for (const loop of loops) {
    for (const [i, k] of loop.entries()) {
      if (i === 0) context.moveTo(...corner(k));
      else context.lineTo(...corner(k));
    }
    context.closePath();
  }
}

function traceWheel(pen: Pen, mark: Mark): void {
  const [x, y, rimX, rimY] = ends(pen, mark);
  const radius = mark.size * pen.camera.scale;
  traceCircle(pen.context, x, y, radius);
  const angle = Math.atan2(rimY - y, rimX - x);
  pen.context.moveTo(x, y);
  pen.context.lineTo(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
}

/** What a bead runs along: a wire, an endless line or a ring. */
function traceGuide(pen: Pen, mark: Mark): void {
  const { context, camera } = pen;
  if (mark.kind === 'ring') traceRing(pen, mark);
  else if (mark.kind === 'line') traceLine(pen, mark);
  else {
    for (let i = 0; 3 * i < mark.points.length; i += 1) {
      const [x, y] = project(camera, mark.points, i);
      if (i === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
    }
  }
}

/** Across the whole canvas, wherever the view is. */
function traceLine(pen: Pen, mark: Mark): void {
  const { context, camera } = pen;
  let [ax, ay, bx, by] = ends(pen, mark);
  if (mark.particles.length < 2) {
    const [ox, oy] = project(camera, [0, 0, 0], 0);
    // the last point is a direction: where the origin would go with it, less where it is
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

/** An arc at the corner from the first arm, or the direction, to the second, the shorter way. */
function traceAngle({ context, camera, screen }: Pen, { particles, points }: Mark): void {
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
  // the direction from which it counts is seen where no arm shows it
  if (particles.length < 4 || particles[0] !== c) {
    context.moveTo(x, y);
    const far = ANGLE_RADIUS + REFERENCE;
    context.lineTo(x + far * Math.cos(from), y + far * Math.sin(from));
  }
  context.moveTo(x + ANGLE_RADIUS * Math.cos(from), y + ANGLE_RADIUS * Math.sin(from));
  context.arc(x, y, ANGLE_RADIUS, from, from + shorter, shorter < 0);
}
