// The running page: which scene, which controls, what the last step said. Panels read its fields and call its methods;
// the stage calls `frame` once per drawn frame.

import {
  type Controls,
  EngineError,
  type IntegratorFacts,
  integrators,
  type Shipped,
  type Structure,
  shippedScenes,
  startEngine,
  type Terms,
} from '../engine';
import type { Selection } from '../view/picture';
import { sceneInAddress } from './address';
import { RealTimeClock } from './clock';
import { downOf, type NumberControl, withControl } from './controls';
import { History } from './history';
import { format } from './numbers';
import { Run } from './run';
import { DEFAULT_SCENE, type SceneSource, sceneFromCommand, shipped } from './scenes';

/** Panels with numbers are refreshed this often; faster nobody reads. */
const PANEL_INTERVAL_MS = 100;

/** A condition that held for one step only would flash by; its words stay this long after it was last met. */
const WARNING_STAYS_MS = 3000;

/** Traces of the history, in this order. */
export const TRACES = ['time', 'kinetic', 'potential', 'total', 'missing', 'residual', 'ghost'] as const;

export type Phase = 'starting' | 'ready' | 'failed';

export class Session {
  phase = $state<Phase>('starting');
  /** why there is no scene, in the engine's words */
  failure = $state<string | null>(null);
  scenes = $state.raw<Shipped[]>([]);
  integrators = $state.raw<IntegratorFacts[]>([]);
  source = $state.raw<SceneSource | null>(null);
  structure = $state.raw<Structure | null>(null);
  controls = $state.raw<Controls | null>(null);
  /** the controls as the scene sets them: what a reset of one control goes back to */
  original = $state.raw<Controls | null>(null);
  /** what the engine said about a control it refused */
  refusal = $state.raw<{ key: string; message: string } | null>(null);

  running = $state(false);
  speed = $state(1);
  time = $state(0);
  ratio = $state(1);
  late = $state(false);
  /** why the run stopped at its last good state */
  stopped = $state.raw<EngineError | null>(null);
  warnings = $state.raw<string[]>([]);
  /** whom auto chose for the last step; null before it, and under any other integrator */
  carrier = $state.raw<Controls['integrator'] | null>(null);
  /** why auto went over to bdf2, in the engine's words; null where it did not */
  tooStiff = $state.raw<string | null>(null);
  residual = $state(0);
  lengthError = $state(0);

  compare = $state(false);
  ghostIntegrator = $state<Controls['integrator']>('euler');
  ghostFormulation = $state<Controls['formulation']>('modern');
  ghostStopped = $state.raw<string | null>(null);
  ghostResidual = $state(0);

  selection = $state.raw<Selection>(null);
  /** every symbol of the state shown; null while no panel asks for it */
  terms = $state.raw<Terms | null>(null);
  termsOpen = $state(false);
  /** counts the refreshes of what the panels show */
  tick = $state(0);

  readonly history = new History(TRACES.length);
  readonly clock = new RealTimeClock(() => performance.now());
  run: Run | null = null;
  ghost: Run | null = null;
  mouse: { particle: number; target: number[] } | null = null;
  /** part of a step that the drawing is behind the state */
  fraction = 1;
  /** called when another scene is there, to fit the view */
  onScene: () => void = () => {};
  private lastPanelMs = 0;
  private warnedMs = -Infinity;

  /** `down` of gravity, a unit vector. */
  get down(): number[] {
    return downOf(this.original?.gravity ?? [], this.structure?.dimension ?? 2);
  }

  async start(): Promise<void> {
    try {
      await startEngine();
    } catch (error) {
      this.fail(`The engine could not be started: ${String(error)}`);
      return;
    }
    this.scenes = shippedScenes();
    this.integrators = integrators();
    await this.openAddress();
  }

  /** Opens what the address names, else what the command was given, else the default. */
  async openAddress(): Promise<void> {
    const name = sceneInAddress(location);
    if (name !== null) this.openNamed(name);
    else this.open((await sceneFromCommand()) ?? shipped(DEFAULT_SCENE)!);
  }

  openNamed(name: string): void {
    const source = shipped(name);
    if (source) this.open(source);
    else this.fail(`No scene is called “${name}”. The list above has all that there are.`);
  }

  /** Something no error was foreseen for: said, and the page stays usable. */
  crash(error: unknown): void {
    this.run = null;
    this.ghost = null;
    this.fail(`The engine broke off: ${String(error)}. Please report the scene.`);
  }

  private fail(message: string): void {
    this.closeRuns();
    this.source = null;
    this.structure = null;
    this.running = false;
    this.failure = message;
    this.phase = 'failed';
  }

  open(source: SceneSource): void {
    let run: Run;
    try {
      run = Run.open(source.text, source.fileName);
    } catch (error) {
      this.fail(error instanceof Error ? error.message : String(error));
      this.source = source;
      return;
    }
    this.closeRuns();
    this.run = run;
    this.source = source;
    this.failure = null;
    this.selection = null;
    this.mouse = null;
    this.refusal = null;
    this.compare = false;
    this.structure = run.simulation.structure();
    this.controls = run.simulation.controls();
    this.original = this.controls;
    this.ghostIntegrator = this.controls.integrator === 'euler' ? 'auto' : 'euler';
    this.ghostFormulation = 'modern';
    this.phase = 'ready';
    this.afterReset();
    this.onScene();
    // someone who asked their system for less motion decides when it moves
    this.running = !matchMedia('(prefers-reduced-motion: reduce)').matches;
  }

  private closeRuns(): void {
    this.run?.close();
    this.ghost?.close();
    this.run = null;
    this.ghost = null;
  }

  private afterReset(): void {
    this.stopped = this.run?.stopped ?? null;
    this.ghostStopped = this.ghost?.stopped?.message ?? null;
    if (this.stopped) this.running = false;
    this.warnings = this.startWarnings();
    this.warnedMs = performance.now();
    this.history.clear();
    this.clock.restart();
    this.fraction = 1;
    this.record();
    this.refresh();
  }

  /** A start that was not consistent is moved, and a person who wrote it wants to know. */
  private startWarnings(): string[] {
    const projection = this.run?.simulation.projection();
    if (!projection || this.run!.simulation.time > 0) return [];
    if (projection.moved === 0 && projection.velocity_changed === 0) return [];
    const moved = `${format(projection.moved)} m and ${format(projection.velocity_changed)} m/s`;
    return [`The start did not satisfy the constraints; it was moved onto them, by at most ${moved}.`];
  }

  play(): void {
    if (!this.run || this.stopped) return;
    this.clock.restart();
    this.running = true;
  }

  pause(): void {
    this.running = false;
    this.fraction = 1;
    this.refresh();
  }

  toggle(): void {
    if (this.running) this.pause();
    else this.play();
  }

  stepOnce(): void {
    if (!this.run) return;
    this.pause();
    this.advance();
    this.record();
    this.refresh();
  }

  reset(): void {
    if (!this.run) return;
    const mouse = this.mouse;
    this.release();
    this.run.reset();
    this.ghost?.reset();
    this.afterReset();
    if (mouse) this.mouse = null;
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.clock.speed = speed;
    this.clock.restart();
  }

  set(key: NumberControl, value: number): void {
    if (this.controls) this.apply(key, withControl(this.controls, key, value, this.down));
  }

  setIntegrator(integrator: Controls['integrator']): void {
    if (this.controls) this.apply('integrator', { ...this.controls, integrator });
  }

  setFormulation(formulation: Controls['formulation']): void {
    if (this.controls) this.apply('formulation', { ...this.controls, formulation });
  }

  private apply(key: string, controls: Controls): void {
    if (!this.run) return;
    try {
      this.run.simulation.setControls(controls);
      this.ghost?.simulation.setControls(this.ghostControls(controls));
      this.refusal = null;
    } catch (error) {
      this.refusal = { key, message: error instanceof Error ? error.message : String(error) };
    }
    this.controls = this.run.simulation.controls();
    // the classic nail has one row where the modern one has two or three
    if (key === 'formulation') this.structure = this.run.simulation.structure();
    this.refresh();
  }

  private ghostControls(controls: Controls): Controls {
    return { ...controls, integrator: this.ghostIntegrator, formulation: this.ghostFormulation };
  }

  /** Both runs start again from the scene's start: only so do they differ by the method alone. */
  setCompare(compare: boolean): void {
    this.compare = compare;
    this.ghost?.close();
    this.ghost = null;
    if (!this.run || !this.controls) return;
    if (compare) {
      try {
        this.ghost = this.run.beside(this.ghostControls(this.controls));
      } catch (error) {
        this.ghostStopped = error instanceof Error ? error.message : String(error);
        return;
      }
    }
    this.reset();
  }

  setGhost(integrator: Controls['integrator'], formulation: Controls['formulation']): void {
    this.ghostIntegrator = integrator;
    this.ghostFormulation = formulation;
    if (this.compare) this.setCompare(true);
  }

  select(selection: Selection): void {
    this.selection = selection;
    this.refresh();
  }

  grab(particle: number, target: number[]): void {
    if (!this.run || this.structure?.fixed[particle]) return;
    this.run.simulation.grab(particle, target);
    this.ghost?.simulation.grab(particle, target);
    this.mouse = { particle, target };
  }

  dragTo(target: number[]): void {
    if (!this.run || !this.mouse) return;
    this.run.simulation.dragTo(target);
    this.ghost?.simulation.dragTo(target);
    this.mouse = { ...this.mouse, target };
  }

  release(): void {
    if (!this.mouse) return;
    this.run?.simulation.release();
    this.ghost?.simulation.release();
    this.mouse = null;
  }

  /** One animation frame: the steps that are due, then what the panels show. */
  frame(timeMs: number): void {
    if (!this.run || !this.controls) return;
    if (this.running) {
      const reading = this.clock.frame(timeMs, this.controls.h, () => this.advance());
      this.fraction = reading.fraction;
      if (reading.steps > 0) this.record();
      if (this.stopped) this.refresh();
    }
    if (timeMs - this.lastPanelMs >= PANEL_INTERVAL_MS && (this.running || this.mouse)) {
      this.lastPanelMs = timeMs;
      this.refresh();
    }
  }

  /** One step of both runs; false where the main one has stopped. */
  private advance(): boolean {
    const run = this.run!;
    if (!run.step()) {
      this.running = false;
      this.fraction = 1;
      this.stopped = run.stopped;
      return false;
    }
    if (run.report!.warnings.length > 0) {
      this.warnings = run.report!.warnings;
      this.warnedMs = performance.now();
    }
    if (this.ghost && !this.ghost.stopped && !this.ghost.step()) {
      this.ghostStopped = this.ghost.stopped!.message;
    }
    return true;
  }

  private record(): void {
    const run = this.run!;
    const energy = run.energy();
    const ghost = this.ghost && !this.ghost.stopped ? this.ghost.report?.max_residual : undefined;
    this.history.push([
      run.simulation.time,
      energy.kinetic,
      energy.potential,
      energy.total,
      energy.missing,
      run.report?.max_residual ?? Number.NaN,
      ghost ?? Number.NaN,
    ]);
  }

  private refresh(): void {
    if (!this.run) return;
    const { report, simulation } = this.run;
    this.time = simulation.time;
    this.ratio = this.clock.ratio;
    this.late = this.running && this.clock.late;
    const choice = this.controls?.integrator === 'auto' ? report : null;
    this.carrier = choice?.integrator ?? null;
    this.tooStiff = choice?.too_stiff ?? null;
    this.residual = report?.max_residual ?? 0;
    this.lengthError = report?.max_relative_length_error ?? 0;
    this.ghostResidual = this.ghost?.report?.max_residual ?? 0;
    const wanted = this.termsOpen || this.selection !== null || !this.running;
    this.terms = wanted ? this.readTerms() : null;
    // a state that stands still is judged by itself, whatever the step before it met
    if (!this.running && this.terms) this.warnings = [...this.startWarnings(), ...this.terms.warnings];
    else if (performance.now() - this.warnedMs > WARNING_STAYS_MS) this.warnings = [];
    this.tick += 1;
  }

  private readTerms(): Terms | null {
    try {
      return this.run!.simulation.terms();
    } catch (error) {
      if (error instanceof EngineError) return null;
      throw error;
    }
  }

  setTermsOpen(open: boolean): void {
    this.termsOpen = open;
    this.refresh();
  }
}
