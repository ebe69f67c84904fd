// Draws one Picture on the canvas, back to front: grid, ghost, what holds particles, springs, rods, nails, particles, the hand.

import type { Link, Structure } from '../engine';
import { isRod } from '../session/links';
import type { Camera } from './camera';
import { drawGrid, drawScale } from './grid';
import { drawHolds } from './holds';
import { drawArrow, traceChains, traceFixed, traceNail, traceSpring } from './marks';
import { DARK, LIGHT, type Palette, TENSION_STEPS, tensionColours, tensionStep } from './palette';
import type { Picture, Selection } from './picture';

/** A usual ball's radius is at most this part of a mean rod on the screen. */
const ROD_SHARE = 0.22;

/** The smallest ball's radius, px. */
const LEAST_RADIUS = 1.5;

export class CanvasView {
  private readonly context: CanvasRenderingContext2D;
  private palette: Palette = LIGHT;
  private colours: string[] = tensionColours(LIGHT);
  /** screen x, y and depth of every particle, of the frame being drawn */
  private screen = new Float64Array(0);
  private radii = new Float64Array(0);
  private radiiOf: Structure | null = null;
  private radiiMost = 0;
  /** m */
  private meanRod = 0;
  /** whether rods are so short on the screen that the smallest balls would touch and hide them all */
  private crowded = false;
  private readonly at = new Float64Array(3);

  constructor(readonly canvas: HTMLCanvasElement) {
    const context = canvas.getContext('2d', { alpha: false });
    if (!context) throw new Error('This browser gives no 2D canvas.');
    this.context = context;
  }

  setDark(dark: boolean): void {
    this.palette = dark ? DARK : LIGHT;
    this.colours = tensionColours(this.palette);
  }

  /** Fits the bitmap to the element; true where it changed. */
  resize(camera: Camera): boolean {
    const { clientWidth, clientHeight } = this.canvas;
    // beyond 2 device pixels a pixel nobody sees the difference and a phone pays for it
    const ratio = Math.min(2, globalThis.devicePixelRatio || 1);
    const [width, height] = [Math.round(clientWidth * ratio), Math.round(clientHeight * ratio)];
    const changed = this.canvas.width !== width || this.canvas.height !== height;
    if (changed) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const moved = changed || camera.width !== clientWidth || camera.height !== clientHeight;
    camera.width = clientWidth;
    camera.height = clientHeight;
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    return moved;
  }

  empty(camera: Camera): void {
    this.context.fillStyle = this.palette.background;
    this.context.fillRect(0, 0, camera.width, camera.height);
    drawGrid(this.context, camera, this.palette);
  }

  draw(picture: Picture, camera: Camera): void {
    this.empty(camera);
    this.measure(picture.structure, camera);
    if (picture.ghost) this.drawGhost(picture, picture.ghost, camera);
    this.place(picture.positions, camera);
    drawHolds(this.context, picture, this.screen, camera, this.palette);
    this.drawSprings(picture.structure);
    if (camera.dimension === 3) this.drawLinksByDepth(picture);
    else this.drawLinksByColour(picture);
    this.drawNails(picture, camera);
    this.drawParticles(picture, camera);
    this.drawHand(picture, camera);
    this.drawArrows(picture, camera);
    drawScale(this.context, camera, this.palette);
  }

  /** What lies under a screen point: the nearest particle in reach, else the nearest link. */
  pick(
    structure: Structure,
    positions: Float64Array,
    camera: Camera,
    x: number,
    y: number,
    reach: number,
  ): Selection {
    this.measure(structure, camera);
    this.place(positions, camera);
    let best: Selection = null;
    let nearest = reach;
    for (let i = 0; i < structure.masses.length; i += 1) {
      const away = Math.hypot(this.screen[3 * i] - x, this.screen[3 * i + 1] - y) - this.radii[i];
      if (away < nearest) [nearest, best] = [away, { kind: 'particle', index: i }];
    }
    if (best) return best;
    // a link is thin: a smaller reach keeps empty canvas empty
    nearest = reach / 2;
    for (const [index, { a, b }] of structure.links.entries()) {
      const away = distanceToSegment(x, y, this.screen, 3 * a, 3 * b);
      if (away < nearest) [nearest, best] = [away, { kind: 'link', index }];
    }
    return best;
  }

  private place(flat: Float64Array, camera: Camera): void {
    const count = flat.length / camera.dimension;
    if (this.screen.length !== 3 * count) this.screen = new Float64Array(3 * count);
    for (let i = 0; i < count; i += 1) {
      camera.project(flat, i, this.at);
      this.screen.set(this.at, 3 * i);
    }
  }

  /**
   * Radii grow with the cube root of the mass, as balls of one stuff do; crowded scenes get smaller ones, and balls
   * never hide the rods between them.
   */
  private measure(structure: Structure, camera: Camera): void {
    const { masses, links } = structure;
    if (this.radiiOf !== structure) {
      const lengths = links.filter(isRod).map(({ longest }) => longest!);
      this.meanRod = lengths.reduce((sum, length) => sum + length, 0) / lengths.length;
    }
    // not a number where there are no rods
    const shown = this.meanRod * camera.scale;
    this.crowded = shown < 2 * LEAST_RADIUS;
    const most = this.meanRod > 0 ? Math.max(LEAST_RADIUS, ROD_SHARE * shown) : Infinity;
    if (this.radiiOf === structure && this.radiiMost === most) return;
    this.radiiOf = structure;
    this.radiiMost = most;
    const count = masses.length;
    const base = Math.min(most, count > 300 ? 2 : count > 60 ? 3.5 : count > 20 ? 4.5 : 6);
    const sorted = Array.from(masses).sort((a, b) => a - b);
    const usual = sorted[Math.floor(count / 2)] || 1;
    this.radii = Float64Array.from(masses, (mass) =>
      Math.min(18, Math.max(LEAST_RADIUS, base * Math.cbrt(mass / usual))),
    );
  }

  private linkWidth({ links }: Structure): number {
    return links.length > 300 ? 2 : links.length > 60 ? 2.75 : 3.5;
  }

  private drawGhost(picture: Picture, ghost: Float64Array, camera: Camera): void {
    this.place(ghost, camera);
    const { context, screen } = this;
    context.strokeStyle = this.palette.ghost;
    context.globalAlpha = picture.ghostStopped ? 0.3 : 0.85;
    context.lineWidth = 2;
    context.setLineDash([5, 4]);
    context.beginPath();
    for (const { a, b } of picture.structure.links.filter(isRod)) this.traceLine(a, b);
    for (const { a, b } of picture.structure.springs) this.traceLine(a, b);
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    for (let i = 0; i < this.radii.length; i += 1) {
      const [x, y, r] = [screen[3 * i], screen[3 * i + 1], this.radii[i]];
      context.moveTo(x + r, y);
      context.arc(x, y, r, 0, 2 * Math.PI);
    }
    context.stroke();
    context.globalAlpha = 1;
  }

  private traceLine(a: number, b: number): void {
    this.context.moveTo(this.screen[3 * a], this.screen[3 * a + 1]);
    this.context.lineTo(this.screen[3 * b], this.screen[3 * b + 1]);
  }

  private drawSprings(structure: Structure): void {
    if (structure.springs.length === 0) return;
    const { context, screen } = this;
    const width = structure.springs.length > 60 ? 3 : 5;
    context.strokeStyle = this.palette.spring;
    context.lineWidth = 1.5;
    context.lineJoin = 'round';
    context.beginPath();
    for (const { a, b } of structure.springs) {
      traceSpring(context, screen[3 * a], screen[3 * a + 1], screen[3 * b], screen[3 * b + 1], width, 6);
    }
    context.stroke();
  }

  /** One path per colour: a thousand links cost forty strokes. */
  private drawLinksByColour(picture: Picture): void {
    const { context } = this;
    const { links } = picture.structure;
    const byStep: Link[][] = Array.from({ length: TENSION_STEPS }, () => []);
    for (let i = 0; i < links.length; i += 1) {
      if (isStraight(picture, i))
        byStep[tensionStep(picture.tension[i], picture.tensionLimit)].push(links[i]);
    }
    context.lineWidth = this.linkWidth(picture.structure);
    context.lineCap = 'round';
    context.lineJoin = 'round';
    for (let step = 0; step < TENSION_STEPS; step += 1) {
      if (byStep[step].length === 0) continue;
      context.strokeStyle = this.colours[step];
      context.beginPath();
      traceChains(context, this.screen, byStep[step]);
      context.stroke();
    }
    this.drawLinkMarks(picture);
  }

  /** Far links first, thinner and paler: the depth cue of a view without perspective. */
  private drawLinksByDepth(picture: Picture): void {
    const { context, screen } = this;
    const { links } = picture.structure;
    const [near, far] = this.depthRange();
    const depth = links.map(({ a, b }) => (screen[3 * a + 2] + screen[3 * b + 2]) / 2);
    const order = links.map((_, i) => i).filter((i) => isStraight(picture, i));
    order.sort((i, j) => depth[i] - depth[j]);
    const width = this.linkWidth(picture.structure);
    context.lineCap = 'round';
    for (const i of order) {
      const part = (depth[i] - far) / (near - far || 1);
      context.globalAlpha = 0.45 + 0.55 * part;
      context.lineWidth = width * (0.6 + 0.6 * part);
      context.strokeStyle = this.colours[tensionStep(picture.tension[i], picture.tensionLimit)];
      context.beginPath();
      this.traceLine(links[i].a, links[i].b);
      context.stroke();
    }
    context.globalAlpha = 1;
    this.drawLinkMarks(picture);
  }

  private depthRange(): [number, number] {
    let [near, far] = [-Infinity, Infinity];
    for (let i = 2; i < this.screen.length; i += 3) {
      near = Math.max(near, this.screen[i]);
      far = Math.min(far, this.screen[i]);
    }
    return [near, far];
  }

  private drawLinkMarks(picture: Picture): void {
    for (const [mark, alpha] of [[picture.hover, 0.25] as const, [picture.selection, 0.55] as const]) {
      if (mark?.kind !== 'link') continue;
      const { a, b } = picture.structure.links[mark.index];
      this.context.globalAlpha = alpha;
      this.context.strokeStyle = this.palette.accent;
      this.context.lineWidth = this.linkWidth(picture.structure) + 7;
      this.context.beginPath();
      this.traceLine(a, b);
      this.context.stroke();
      this.context.globalAlpha = 1;
    }
  }

  private drawNails(picture: Picture, camera: Camera): void {
    if (picture.structure.nails.length === 0) return;
    const { context, at } = this;
    context.strokeStyle = this.palette.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    for (const nail of picture.structure.nails) {
      camera.project(nail.at, 0, at);
      traceNail(context, at[0], at[1], this.radii[nail.particle] + 4);
    }
    context.stroke();
  }

  private drawParticles(picture: Picture, camera: Camera): void {
    const { context, screen, radii } = this;
    const { fixed } = picture.structure;
    context.fillStyle = this.palette.particle;
    context.strokeStyle = this.palette.particleRim;
    context.lineWidth = 1.5;
    const order = fixed.map((_, i) => i);
    if (camera.dimension === 3) order.sort((i, j) => screen[3 * i + 2] - screen[3 * j + 2]);
    // one path is far cheaper; only 3D needs each ball over the one behind it
    const single = camera.dimension === 2 && radii.length > 60;
    if (single) context.beginPath();
    for (const i of order) {
      if (single && this.crowded && radii[i] === LEAST_RADIUS && !fixed[i]) continue;
      const [x, y, r] = [screen[3 * i], screen[3 * i + 1], radii[i]];
      if (!single) context.beginPath();
      context.moveTo(x + r, y);
      if (fixed[i]) traceFixed(context, x, y, r + 1);
      else context.arc(x, y, r, 0, 2 * Math.PI);
      if (single) continue;
      context.fill();
      context.stroke();
    }
    if (single) context.fill();
    this.drawParticleMark(picture.hover, 3, 0.5);
    this.drawParticleMark(picture.selection, 4, 1);
  }

  private drawParticleMark(mark: Selection, gap: number, alpha: number): void {
    if (mark?.kind !== 'particle') return;
    const { context, screen } = this;
    context.globalAlpha = alpha;
    context.strokeStyle = this.palette.accent;
    context.lineWidth = 2.5;
    context.beginPath();
    context.arc(
      screen[3 * mark.index],
      screen[3 * mark.index + 1],
      this.radii[mark.index] + gap,
      0,
      2 * Math.PI,
    );
    context.stroke();
    context.globalAlpha = 1;
  }

  /** The mouse spring, from the particle to the hand. */
  private drawHand(picture: Picture, camera: Camera): void {
    if (!picture.mouse) return;
    const { context, at, screen } = this;
    camera.project(picture.mouse.target, 0, at);
    const i = picture.mouse.particle;
    context.strokeStyle = this.palette.accent;
    context.lineWidth = 2;
    context.lineJoin = 'round';
    context.beginPath();
    traceSpring(context, screen[3 * i], screen[3 * i + 1], at[0], at[1], 4, 7);
    context.moveTo(at[0] + 7, at[1]);
    context.arc(at[0], at[1], 7, 0, 2 * Math.PI);
    context.stroke();
  }

  /** The forces on the selected particle, the larger one 90 px long. */
  private drawArrows(picture: Picture, camera: Camera): void {
    const { context, screen } = this;
    const largest = Math.max(...picture.arrows.map(({ force }) => Math.hypot(...force)), 0);
    if (!(largest > 0)) return;
    context.font = 'italic 600 13px system-ui, sans-serif';
    context.lineWidth = 2;
    for (const { particle, force, colour, label } of picture.arrows) {
      const along = (axis: readonly number[]) =>
        force.reduce((sum, component, k) => sum + component * axis[k], 0) * (90 / largest);
      context.strokeStyle = this.palette[colour];
      context.fillStyle = this.palette[colour];
      const [dx, dy] = [along(camera.right), -along(camera.up)];
      drawArrow(context, screen[3 * particle], screen[3 * particle + 1], dx, dy, label);
    }
  }
}

/** A rod until it breaks, a rope or a strut while it carries something: without, it is drawn as the mark that it is. */
function isStraight({ structure, tension, broken }: Picture, place: number): boolean {
  return isRod(structure.links[place]) ? !broken.has(place) : Math.abs(tension[place]) > 0;
}

function distanceToSegment(x: number, y: number, flat: Float64Array, a: number, b: number): number {
  const [dx, dy] = [flat[b] - flat[a], flat[b + 1] - flat[a + 1]];
  const square = dx * dx + dy * dy;
  const along = square > 0 ? ((x - flat[a]) * dx + (y - flat[a + 1]) * dy) / square : 0;
  const t = Math.max(0, Math.min(1, along));
  return Math.hypot(x - flat[a] - t * dx, y - flat[a + 1] - t * dy);
}
