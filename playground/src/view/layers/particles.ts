// Particles: discs, squares for fixed particles; then the ring that highlights a particle.

import type { Brush } from '../brush';
import { traceCircle, traceFixed } from '../glyphs';
import type { Picture } from '../picture';
import { LEAST_RADIUS } from '../sizes';

/** Number of particles in the plane above which they are drawn as one path without rims. */
const MOST_WITH_RIMS = 60;

export function drawParticles(brush: Brush, picture: Picture): void {
  const { camera, sizes } = brush;
  // in space each disc must cover the discs behind it, which one path cannot do
  if (camera.dimension === 2 && sizes.radii.length > MOST_WITH_RIMS) drawTogether(brush, picture);
  else drawEach(brush, picture);
  highlight(brush, picture.hover, 3, 0.5);
  highlight(brush, picture.selection, 4, 1);
}

function drawTogether({ context, palette, screen, sizes }: Brush, { structure: { fixed } }: Picture): void {
  const { radii, crowded } = sizes;
  context.fillStyle = palette.particle;
  context.beginPath();
  for (const [i, isFixed] of fixed.entries()) {
    if (crowded && radii[i] === LEAST_RADIUS && !isFixed) continue;
    trace(context, screen, i, radii[i], isFixed);
  }
  context.fill();
}

function drawEach({ context, camera, palette, screen, sizes }: Brush, picture: Picture): void {
  const { fixed } = picture.structure;
  const order = fixed.map((_, i) => i);
  if (camera.dimension === 3) order.sort((i, j) => screen[3 * i + 2] - screen[3 * j + 2]);
  context.fillStyle = palette.particle;
  context.strokeStyle = palette.background;
  context.lineWidth = 1.5;
  for (const i of order) {
    context.beginPath();
    trace(context, screen, i, sizes.radii[i], fixed[i]);
    context.fill();
    context.stroke();
  }
}

function trace(
  context: CanvasRenderingContext2D,
  screen: Float64Array,
  particle: number,
  radius: number,
  isFixed: boolean,
): void {
  const [x, y] = [screen[3 * particle], screen[3 * particle + 1]];
  if (isFixed) traceFixed(context, x, y, radius + 1);
  else traceCircle(context, x, y, radius);
}

function highlight(
  { context, palette, screen, sizes }: Brush,
  selection: Picture['selection'],
  gap: number,
  opacity: number,
): void {
  if (selection?.kind !== 'particle') return;
  const { index } = selection;
  context.globalAlpha = opacity;
  context.strokeStyle = palette.accent;
  context.lineWidth = 2.5;
  context.beginPath();
  traceCircle(context, screen[3 * index], screen[3 * index + 1], sizes.radii[index] + gap);
  context.stroke();
  context.globalAlpha = 1;
}
