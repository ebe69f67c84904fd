// Rods, and ropes and struts that carry a force, coloured by tension; then the highlight of a link.

import type { Link } from '../../engine';
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

/** One path a colour: a thousand links cost at most as many strokes as there are colours. */
function drawByColour({ context, palette, screen, sizes }: Brush, picture: Picture): void {
  const { links } = picture.structure;
  const byStep: Link[][] = Array.from({ length: TENSION_STEPS }, () => []);
  for (const [i, link] of links.entries()) {
    if (isStraight(picture, i)) byStep[tensionStep(picture.tension[i], picture.tensionLimit)].push(link);
  }
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
  const { links } = picture.structure;
  const [near, far] = depthRange(screen);
  const depth = links.map(({ a, b }) => (screen[3 * a + 2] + screen[3 * b + 2]) / 2);
  const order = links.map((_, i) => i).filter((i) => isStraight(picture, i));
  order.sort((i, j) => depth[i] - depth[j]);
  context.lineCap = 'round';
  for (const i of order) {
    const part = (depth[i] - far) / (near - far || 1);
    context.globalAlpha = 0.45 + 0.55 * part;
    context.lineWidth = sizes.link * (0.6 + 0.6 * part);
    context.strokeStyle = palette.tension[tensionStep(picture.tension[i], picture.tensionLimit)];
    context.beginPath();
    traceSegment(context, screen, links[i]);
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
  traceSegment(context, screen, structure.links[selection.index]);
  context.stroke();
  context.globalAlpha = 1;
}

/** A rod is straight until it breaks, a rope or strut while it carries a force; otherwise its shape alone is drawn. */
function isStraight({ structure, tension, broken }: Picture, place: number): boolean {
  return isRod(structure.links[place]) ? !broken.has(place) : Math.abs(tension[place]) > 0;
}
