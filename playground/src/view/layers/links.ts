// Rods, and ropes and struts that carry a force, coloured by tension; then the highlight of a link.

import { isLink, type LinkShape } from '../../engine';
import { isRod } from '../../session/links';
import type { Brush } from '../brush';
import { traceChains, traceSegment } from '../glyphs';
import { TENSION_STEPS, tensionStep } from '../palette';
import type { Picture } from '../picture';

export function drawLinks(brush: Brush, picture: Picture): void {
  if (brush.camera.dimension === 3) drawByDepth(brush, picture);
  else drawByColour(brush, picture);
  highlight(brush, picture, picture.hover, 0.25);
  highlight(brush, picture, picture.selection, 0.55);
}

/** One path for each colour: a thousand links need at most as many strokes as there are colours. */
function drawByColour({ context, palette, screen, sizes }: Brush, picture: Picture): void {
  const byStep: LinkShape[][] = Array.from({ length: TENSION_STEPS }, () => []);
  for (const shape of straight(picture)) byStep[stepOf(shape, picture)].push(shape);
  context.lineWidth = sizes.link;
  context.lineCap = 'round';
  context.lineJoin = 'round';
  for (const [step, members] of byStep.entries()) {
    if (members.length === 0) continue;
    context.strokeStyle = palette.tension[step];
    context.beginPath();
    traceChains(context, screen, members);
    context.stroke();
  }
}

/** Far links first, thinner and paler: the depth cue of a view without perspective. */
function drawByDepth({ context, palette, screen, sizes }: Brush, picture: Picture): void {
  const [near, far] = depthRange(screen);
  const order = straight(picture).map((shape) => {
    const [a, b] = shape.particles;
    return { shape, depth: (screen[3 * a + 2] + screen[3 * b + 2]) / 2 };
  });
  order.sort((one, other) => one.depth - other.depth);
  context.lineCap = 'round';
  for (const { shape, depth } of order) {
    const part = (depth - far) / (near - far || 1);
    context.globalAlpha = 0.45 + 0.55 * part;
    context.lineWidth = sizes.link * (0.6 + 0.6 * part);
    context.strokeStyle = palette.tension[stepOf(shape, picture)];
    context.beginPath();
    traceSegment(context, screen, shape.particles);
    context.stroke();
  }
  context.globalAlpha = 1;
}

/** The nearest and the farthest depth of a particle, m. */
function depthRange(screen: Float64Array): [number, number] {
  let [near, far] = [-Infinity, Infinity];
  for (let i = 2; i < screen.length; i += 3) {
    near = Math.max(near, screen[i]);
    far = Math.min(far, screen[i]);
  }
  return [near, far];
}

function highlight(
  { context, palette, screen, sizes }: Brush,
  { structure }: Picture,
  selection: Picture['selection'],
  opacity: number,
): void {
  if (selection?.kind !== 'link') return;
  context.globalAlpha = opacity;
  context.strokeStyle = palette.accent;
  context.lineWidth = sizes.link + 7;
  context.beginPath();
  traceSegment(context, screen, structure.links[selection.index].particles);
  context.stroke();
  context.globalAlpha = 1;
}

/** Rods, and the ropes and struts that carry a force; the shapes layer draws the other ropes and struts alone. */
function straight({ shapes, tension }: Picture): LinkShape[] {
  return shapes.filter(isLink).filter((shape) => isRod(shape) || Math.abs(tension[shape.link.place]) > 0);
}

function stepOf({ link }: LinkShape, { tension, tensionLimit }: Picture): number {
  return tensionStep(tension[link.place], tensionLimit);
}
