// The canvas, its camera and the drawing loop: asks the session for a frame, draws what it finds.

import type { Mark } from '../engine';
import { unbroken } from '../session/links';
import { niceCeiling } from '../session/numbers';
import { boxOfMotion } from '../session/scout';
import type { Session } from '../session/session.svelte';
import { type Box, Camera } from './camera';
import { CanvasView } from './canvas';
import type { Arrow, Picture, Selection } from './picture';

/** Above this a step is shown as the jump it is; below, the drawing slides from one state to the next. */
const LONGEST_SMOOTHED_STEP = 1 / 30;

/** A peak of tension is half forgotten after 140 frames, about two seconds. */
const FADE = 0.995;

export class Stage {
  camera = new Camera(2);
  readonly view: CanvasView;
  hover: Selection = null;
  /** ends of the colour scale, N */
  tensionLimit = 1;
  /** the largest tension of late, N */
  private loudest = 0;
  onTensionLimit: (limit: number) => void = () => {};
  private box: Box | null = null;
  private marks: Mark[] = [];
  private request = 0;
  /** true until a person moves the view: only then may it follow a changed window */
  private fitted = true;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly session: Session,
  ) {
    this.view = new CanvasView(canvas);
    session.onScene = () => this.openScene();
  }

  start(): void {
    const loop = (timeMs: number) => {
      this.request = requestAnimationFrame(loop);
      try {
        this.session.frame(timeMs);
        this.draw();
      } catch (error) {
        this.session.crash(error);
      }
    };
    this.request = requestAnimationFrame(loop);
  }

  stop(): void {
    cancelAnimationFrame(this.request);
  }

  private openScene(): void {
    const { run, structure } = this.session;
    if (!run || !structure) return;
    const gravity = run.simulation.controls().gravity;
    const { inset } = this.camera;
    this.camera = new Camera(structure.dimension, Math.abs(gravity[1]) > Math.abs(gravity[2]) ? 1 : 2);
    this.camera.inset = inset;
    this.box = boxOfMotion(run.simulation, structure);
    this.marks = run.simulation.marks(run.simulation.time);
    this.hover = null;
    this.loudest = 0;
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

  /** What panels cover, px; a view nobody has moved stays fitted to the rest. */
  setInset(inset: Camera['inset']): void {
    const old = this.camera.inset;
    if ((Object.keys(inset) as (keyof typeof inset)[]).every((side) => inset[side] === old[side])) return;
    this.camera.inset = inset;
    if (this.fitted) this.fit();
  }

  pick(x: number, y: number, reach: number): Selection {
    const { run, structure } = this.session;
    return run && structure
      ? this.view.pick(structure, run.simulation.positions(), this.camera, x, y, reach)
      : null;
  }

  positionOf(particle: number): number[] {
    const d = this.camera.dimension;
    return Array.from(this.session.run!.simulation.positions().subarray(d * particle, d * particle + d));
  }

  draw(): void {
    if (this.view.resize(this.camera) && this.fitted) this.fit();
    const { run, ghost, structure } = this.session;
    if (!run || !structure) {
      this.view.empty(this.camera);
      return;
    }
    const tension = this.readTension();
    const broken = new Set(run.simulation.broken());
    this.followTension(tension);
    const picture: Picture = {
      structure,
      positions: this.smoothed(run.simulation),
      marks: unbroken(this.marksNow(run.simulation), structure.links, broken),
      down: this.session.down,
      tension,
      broken,
      tensionLimit: this.tensionLimit,
      ghost: ghost ? this.smoothed(ghost.simulation) : null,
      ghostStopped: this.session.ghostStopped !== null,
      selection: this.session.selection,
      hover: this.hover,
      mouse: this.session.mouse,
      arrows: this.arrows(),
    };
    this.view.draw(picture, this.camera);
  }

  /** How far the drawing is behind the state, s. */
  private behind(): number {
    const h = this.session.controls?.h ?? 0;
    return h > LONGEST_SMOOTHED_STEP || !this.session.running ? 0 : (1 - this.session.fraction) * h;
  }

  /** Positions part of a step back along the velocity, so that steps and screen frames out of beat do not judder. */
  private smoothed(simulation: NonNullable<Session['run']>['simulation']): Float64Array {
    const positions = simulation.positions();
    const back = this.behind();
    if (back <= 0) return positions;
    const velocities = simulation.velocities();
    for (let i = 0; i < positions.length; i += 1) positions[i] -= back * velocities[i];
    return positions;
  }

  /** Asked for again only where something is led. */
  private marksNow(simulation: NonNullable<Session['run']>['simulation']): Mark[] {
    if (this.marks.some(({ driven }) => driven))
      this.marks = simulation.marks(simulation.time - this.behind());
    return this.marks;
  }

  private readTension(): Float64Array {
    try {
      return this.session.run!.simulation.tension();
    } catch {
      // a state at which λ does not exist has no tension to colour; the session says so in words
      return new Float64Array(this.session.structure!.links.length).fill(Number.NaN);
    }
  }

  /** The scale grows at once and shrinks slowly, in round numbers, so that colours keep their meaning while one looks. */
  private followTension(tension: Float64Array): void {
    if (this.session.running) this.loudest *= FADE;
    for (const value of tension) {
      if (Number.isFinite(value)) this.loudest = Math.max(this.loudest, Math.abs(value));
    }
    const limit = niceCeiling(this.loudest);
    if (limit === this.tensionLimit) return;
    this.tensionLimit = limit;
    this.onTensionLimit(limit);
  }

  private arrows(): Arrow[] {
    const { selection, terms } = this.session;
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
