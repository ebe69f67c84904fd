// The style of each kind of shape. Nails and the colours of tension have layers of their own.

import type { Shape, ShapeKind } from '../../engine';
import type { Brush } from '../brush';
import type { Picture } from '../picture';
import { isBeyond, traceBetween, traceCoil, traceSlack, traceTaut } from './between';
import { traceAngle, traceGuide } from './guides';
import {
  traceActuator,
  traceArea,
  traceBall,
  traceBox,
  traceGreatCircles,
  traceGround,
  tracePlane,
  traceWheel,
} from './solids';

export interface Style {
  kinds: readonly ShapeKind[];
  /** its name in the palette */
  colour: 'ink' | 'outline' | 'guide' | 'background' | 'accent' | 'spring';
  /** width of the outline, px; 0 for no outline */
  width: number;
  /** lengths of dashes and gaps, px */
  dash?: readonly number[];
  /** opacity of the inside; without it only the outline is drawn */
  fill?: number;
  /** Adds a shape to the path. */
  trace(brush: Brush, shape: Shape, picture: Picture): void;
}

/** The styles, from back to front. */
export const STYLES: readonly Style[] = [
  { kinds: ['area'], colour: 'accent', width: 0, fill: 0.14, trace: traceArea },
  { kinds: ['ground'], colour: 'outline', width: 1.25, trace: traceGround },
  { kinds: ['plane', 'ground'], colour: 'guide', width: 1, trace: tracePlane },
  { kinds: ['ball'], colour: 'outline', width: 1.5, fill: 0.16, trace: traceBall },
  { kinds: ['bowl'], colour: 'outline', width: 1.5, trace: traceBall },
  { kinds: ['ball', 'bowl'], colour: 'guide', width: 1, trace: traceGreatCircles },
  { kinds: ['box'], colour: 'outline', width: 1.5, fill: 0.16, trace: traceBox },
  { kinds: ['wheel'], colour: 'outline', width: 2, fill: 0.12, trace: traceWheel },
  { kinds: ['wire', 'line', 'ring'], colour: 'guide', width: 5, trace: traceGuide },
  { kinds: ['wire', 'line', 'ring'], colour: 'background', width: 2, trace: traceGuide },
  { kinds: ['tie'], colour: 'outline', width: 1.5, dash: [1.5, 5], trace: traceBetween },
  { kinds: ['rope'], colour: 'ink', width: 1.25, dash: [4, 4], trace: traceSlack },
  { kinds: ['cord', 'rope'], colour: 'ink', width: 1.75, trace: traceTaut },
  {
    kinds: ['strut'],
    colour: 'outline',
    width: 4,
    trace: (brush, shape, picture) => isBeyond(picture, shape) || traceBetween(brush, shape),
  },
  {
    kinds: ['strut'],
    colour: 'outline',
    width: 2,
    dash: [6, 5],
    trace: (brush, shape, picture) => isBeyond(picture, shape) && traceBetween(brush, shape),
  },
  { kinds: ['driven-rod', 'actuator'], colour: 'outline', width: 2.5, trace: traceBetween },
  { kinds: ['driven-rod', 'actuator'], colour: 'outline', width: 7, trace: traceActuator },
  { kinds: ['angle'], colour: 'accent', width: 2, trace: traceAngle },
  { kinds: ['spring'], colour: 'spring', width: 1.5, trace: traceCoil },
];
