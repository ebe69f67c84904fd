// Draws one picture on the canvas, layer by layer.

import type { Structure } from '../engine';
import { type Brush, type Layer, particlesOnScreen } from './brush';
import type { Camera } from './camera';
import { drawArrows } from './layers/arrows';
import { drawGhost } from './layers/ghost';
import { drawGrid } from './layers/grid';
import { drawHand } from './layers/hand';
import { drawLinks } from './layers/links';
import { drawNails } from './layers/nails';
import { drawParticles } from './layers/particles';
import { drawScale } from './layers/scale';
import { drawShapes } from './layers/shapes';
import type { Palette } from './palette';
import { pick } from './pick';
import type { Picture, Selection } from './picture';
import { Sizes } from './sizes';

/** The layers, from back to front. */
const LAYERS: readonly Layer[] = [
  drawGrid,
  drawGhost,
  drawShapes,
  drawLinks,
  drawNails,
  drawParticles,
  drawHand,
  drawArrows,
  drawScale,
];

/** Most device pixels for each CSS pixel: more than two are hard to see, and slow on a phone. */
const LARGEST_PIXEL_RATIO = 2;

export class CanvasView {
  private readonly context: CanvasRenderingContext2D;
  private readonly sizes = new Sizes();

  constructor(
    readonly canvas: HTMLCanvasElement,
    public palette: Palette,
  ) {
    const context = canvas.getContext('2d', { alpha: false });
    if (!context) throw new Error('This browser gives no 2D canvas.');
    this.context = context;
  }

  /** Fits the bitmap to the element; true if its size changed. */
  resize(camera: Camera): boolean {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = Math.min(LARGEST_PIXEL_RATIO, globalThis.devicePixelRatio || 1);
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

  /** Draws the background only, if there is no scene. */
  empty(camera: Camera): void {
    this.clear(camera);
    drawGrid(this.brush(camera, new Float64Array(0)));
  }

  draw(picture: Picture, camera: Camera): void {
    this.clear(camera);
    this.sizes.fit(picture.structure, camera.scale);
    const brush = this.brush(camera, particlesOnScreen(camera, picture.positions));
    for (const draw of LAYERS) draw(brush, picture);
  }

  /** The particle or link under a point of the screen; x, y and reach in px. */
  pick(
    structure: Structure,
    positions: Float64Array,
    camera: Camera,
    x: number,
    y: number,
    reach: number,
  ): Selection {
    this.sizes.fit(structure, camera.scale);
    return pick(structure, particlesOnScreen(camera, positions), this.sizes.radii, x, y, reach);
  }

  private clear(camera: Camera): void {
    this.context.fillStyle = this.palette.background;
    this.context.fillRect(0, 0, camera.width, camera.height);
  }

  private brush(camera: Camera, screen: Float64Array): Brush {
    const { context, palette, sizes } = this;
    return { context, camera, palette, sizes, screen };
  }
}
