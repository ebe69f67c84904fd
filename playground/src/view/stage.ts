// The stage: the canvas, its camera and the drawing loop, which runs the steps that are due and draws the state.

import type { Simulation } from '../engine';
import type { Page } from '../page';
import { unbroken } from '../session/links';
import { niceCeiling } from '../session/numbers';
import { boxOfMotion } from '../session/preview';
import { Signal } from '../session/signal';
import { type Box, Camera } from './camera';
import { CanvasView } from './canvas';
import type { Arrow, Picture, Selection } from './picture';

/** Longest step between whose states the drawing interpolates, s; longer steps are shown as jumps. */
const LONGEST_SMOOTHED_STEP = 1 / 30;

/** Factor of the largest tension in each frame: half of a peak is left after 140 frames, about two seconds. */
const FADE = 0.995;

/** The parts of the page that the stage reads. */
type Parts = Pick<Page, 'session' | 'comparison' | 'hand' | 'playback' | 'readings' | 'theme'>;

export class Stage {
  camera = new Camera(2);
  readonly view: CanvasView;
  hover: Selection = null;
  /** ends of the colour scale, N */
  tensionLimit = 1;
  /** the largest recent tension, N: a maximum that decays */
  private largest = 0;
  /** The ends of the colour scale changed, N. */
  readonly tensionLimitChanged = new Signal<[number]>();
  private box: Box | null = null;
  private request = 0;
  /** true until a person moves the view: until then the view is fitted to a changed window */
  private fitted = true;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly parts: Parts,
  ) {
    this.view = new CanvasView(canvas, parts.theme.palette);
    parts.session.opened.listen(() => this.openScene());
  }

  start(): void {
    const loop = (timeMs: number) => {
      this.request = requestAnimationFrame(loop);
      try {
        this.parts.playback.frame(timeMs);
        this.parts.readings.frame(timeMs);
        this.draw();
      } catch (error) {
        this.parts.session.crash(error);
      }
    };
    this.request = requestAnimationFrame(loop);
  }

  stop(): void {
    cancelAnimationFrame(this.request);
  }

  private openScene(): void {
    const { run, structure } = this.parts.session;
    if (!run || !structure) return;
    const gravity = run.simulation.controls().gravity;
    const { inset } = this.camera;
    this.camera = new Camera(structure.dimension, Math.abs(gravity[1]) > Math.abs(gravity[2]) ? 1 : 2);
    this.camera.inset = inset;
    this.box = boxOfMotion(run.simulation, structure);
    this.hover = null;
    this.largest = 0;
    this.view.resize(this.camera);
    this.fit();
  }

  fit(): void {
    if (this.box) this.camera.fit(this.box);
    this.fitted = true;
  }

  pan(dx: number, dy: number): void {
    this.camera.pan(dx, dy);
    this.fitted = false;
  }

  zoom(factor: number, x?: number, y?: number): void {
    const [mx, my] = this.camera.middle;
    this.camera.zoom(factor, x ?? mx, y ?? my);
    this.fitted = false;
  }

  orbit(dx: number, dy: number): void {
    this.camera.orbit(dx, dy);
  }

  /** Sets the width that panels cover, px; a view that no person has moved stays fitted to the rest. */
  setInset(inset: Camera['inset']): void {
    const old = this.camera.inset;
    if ((Object.keys(inset) as (keyof typeof inset)[]).every((side) => inset[side] === old[side])) return;
    this.camera.inset = inset;
    if (this.fitted) this.fit();
  }

  pick(x: number, y: number, reach: number): Selection {
    const { run, structure } = this.parts.session;
    return run && structure
      ? this.view.pick(structure, run.simulation.positions(), this.camera, x, y, reach)
      : null;
  }

  positionOf(particle: number): number[] {
    const d = this.camera.dimension;
    return Array.from(
      this.parts.session.run!.simulation.positions().subarray(d * particle, d * particle + d),
    );
  }

  draw(): void {
    if (this.view.resize(this.camera) && this.fitted) this.fit();
    const { session, comparison, hand, readings, theme } = this.parts;
    const { run, structure } = session;
    this.view.palette = theme.palette;
    if (!run || !structure) {
      this.view.empty(this.camera);
      return;
    }
    const tension = this.readTension();
    this.followTension(tension);
    const picture: Picture = {
      structure,
      positions: this.smoothed(run.simulation),
      shapes: unbroken(
        run.simulation.shapesAt(structure.shapes, run.simulation.time - this.behind()),
        new Set(run.simulation.broken()),
      ),
      down: session.down,
      tension,
      tensionLimit: this.tensionLimit,
      ghost: comparison.ghost ? this.smoothed(comparison.ghost.simulation) : null,
      ghostStopped: comparison.stopped !== null,
      selection: readings.selection,
      hover: this.hover,
      held: hand.held,
      arrows: this.arrows(),
    };
    this.view.draw(picture, this.camera);
  }

  /** The time by which the drawing is behind the state, s. */
  private behind(): number {
    const { session, playback } = this.parts;
    const h = session.controls?.h ?? 0;
    return h > LONGEST_SMOOTHED_STEP || !playback.running ? 0 : (1 - playback.fraction) * h;
  }

  /** Positions a part of a step back along the velocity: motion is even although steps and frames do not coincide. */
  private smoothed(simulation: Simulation): Float64Array {
    const positions = simulation.positions();
    const back = this.behind();
    if (back <= 0) return positions;
    const velocities = simulation.velocities();
    for (let i = 0; i < positions.length; i += 1) positions[i] -= back * velocities[i];
    return positions;
  }

  private readTension(): Float64Array {
    const { run, structure } = this.parts.session;
    try {
      return run!.simulation.tension();
    } catch {
      // a state at which λ does not exist has no tension to colour; the readings show a message
      return new Float64Array(structure!.links.length).fill(Number.NaN);
    }
  }

  /** The scale grows at once and shrinks slowly, in round numbers, so that a colour keeps its meaning for a while. */
  private followTension(tension: Float64Array): void {
    if (this.parts.playback.running) this.largest *= FADE;
    for (const value of tension) {
      if (Number.isFinite(value)) this.largest = Math.max(this.largest, Math.abs(value));
    }
    const limit = niceCeiling(this.largest);
    if (limit === this.tensionLimit) return;
    this.tensionLimit = limit;
    this.tensionLimitChanged.send(limit);
  }

  private arrows(): Arrow[] {
    const { selection, terms } = this.parts.readings;
    if (selection?.kind !== 'particle' || !terms) return [];
    const d = this.camera.dimension;
    const part = (flat: Float64Array) =>
      Array.from(flat.subarray(d * selection.index, d * selection.index + d));
    return [
      { particle: selection.index, force: part(terms.applied_forces), colour: 'ink', label: 'Q' },
      { particle: selection.index, force: part(terms.constraint_forces), colour: 'accent', label: 'Q̂' },
    ];
  }
}
