// Draws the engine's marks: what holds particles and is no rod, nail or spring. One path a style, back to front in the order of STYLES.

import type { Mark, MarkKind } from '../engine';
import type { Camera } from './camera';
import { traceAngle, traceGuide } from './hold-guides';
import { isBeyond, traceBetween, traceCoil, traceSlack, traceTaut } from './hold-links';
import {
  traceActuator,
  traceArea,
  traceBall,
  traceBox,
  traceGreatCircles,
  traceGround,
  tracePlane,
  traceWheel,
} from './hold-shapes';
import { traceNail } from './marks';
import type { Palette } from './palette';
import { type Pen, project } from './pen';
import type { Picture } from './picture';

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
  { kinds: ['plane', 'ground'], colour: 'guide', width: 1, trace: tracePlane },
  { kinds: ['ball'], colour: 'muted', width: 1.5, fill: 0.16, trace: traceBall },
  { kinds: ['bowl'], colour: 'muted', width: 1.5, trace: traceBall },
  { kinds: ['ball', 'bowl'], colour: 'guide', width: 1, trace: traceGreatCircles },
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
