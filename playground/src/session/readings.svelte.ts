// The numbers and messages that the panels show about the running scene, refreshed as fast as a person can read.

import { type Controls, EngineError, type StepEvent, type StepReport, type Terms } from '../engine';
import type { Selection } from '../view/picture';
import type { Comparison } from './comparison.svelte';
import { withEvents } from './events';
import type { Hand } from './hand';
import { History } from './history';
import { format } from './numbers';
import type { Playback } from './playback.svelte';
import type { Session } from './session.svelte';

/** Time between two refreshes of the panels, ms: ten a second are as many as a person can read. */
const PANEL_INTERVAL_MS = 100;

/** Time for which a warning is shown after the last step that raised it, ms. A warning of a single step would flash. */
const WARNING_STAYS_MS = 3000;

/** Traces of the history, in this order: time in s, energies in J, max |C| of the run and of the ghost. */
const TRACES = ['time', 'kinetic', 'potential', 'total', 'missing', 'residual', 'ghost'] as const;

export type TraceName = (typeof TRACES)[number];

export class Readings {
  /** s */
  time = $state(0);
  /** simulated seconds per wall second, relative to the chosen speed */
  ratio = $state(1);
  /** true if the machine cannot hold the chosen speed */
  late = $state(false);
  warnings = $state.raw<string[]>([]);
  /** integrator that `auto` chose for the last step; null before the first step or under any other integrator */
  chosen = $state.raw<Controls['integrator'] | null>(null);
  /** why `auto` changed to bdf2: the message of the engine; null if it did not */
  tooStiff = $state.raw<string | null>(null);
  /** how the last step was solved; null before the first step */
  solver = $state.raw<StepReport['solver'] | null>(null);
  /** the last events, newest first */
  events = $state.raw<readonly StepEvent[]>([]);
  /** the particle or link that a person clicked */
  selection = $state.raw<Selection>(null);
  /** every symbol of the state shown; null while no panel needs it */
  terms = $state.raw<Terms | null>(null);
  termsOpen = $state(false);
  /** counts the refreshes */
  tick = $state(0);
  private readonly history = new History(TRACES.length);
  private lastRefreshMs = 0;
  private warnedMs = -Infinity;
  /** the last events, including events that the next refresh will show */
  private lastEvents: readonly StepEvent[] = [];

  constructor(
    private readonly session: Session,
    private readonly comparison: Comparison,
    private readonly playback: Playback,
    private readonly hand: Hand,
  ) {
    session.closing.listen(() => {
      this.selection = null;
      this.terms = null;
    });
    session.controlsSettled.listen(() => this.refresh());
    playback.restarted.listen(() => this.begin());
    playback.stepped.listen((report) => this.take(report));
    playback.moved.listen(() => this.record());
    playback.halted.listen(() => this.refresh());
  }

  select(selection: Selection): void {
    this.selection = selection;
    this.refresh();
  }

  setTermsOpen(open: boolean): void {
    this.termsOpen = open;
    this.refresh();
  }

  /** One trace, oldest value first; null where the trace has no value. */
  trace(name: TraceName): (number | null)[] {
    return this.history.trace(TRACES.indexOf(name));
  }

  /** The newest value of a trace; NaN if the trace has none. */
  last(name: TraceName): number {
    return this.history.last(TRACES.indexOf(name));
  }

  /** Refreshes the panels of a scene that moves, if the time for a refresh has come. */
  frame(timeMs: number): void {
    if (timeMs - this.lastRefreshMs < PANEL_INTERVAL_MS || !(this.playback.running || this.hand.held)) return;
    this.lastRefreshMs = timeMs;
    this.refresh();
  }

  private begin(): void {
    this.warnings = this.startWarnings();
    this.warnedMs = performance.now();
    this.lastEvents = [];
    this.history.clear();
    this.record();
    this.refresh();
  }

  private take({ warnings, events }: StepReport): void {
    this.lastEvents = withEvents(this.lastEvents, events);
    if (warnings.length === 0) return;
    this.warnings = warnings;
    this.warnedMs = performance.now();
  }

  private record(): void {
    const run = this.session.run!;
    const { ghost } = this.comparison;
    const energy = run.energy();
    this.history.push([
      run.simulation.time,
      energy.kinetic,
      energy.potential,
      energy.total,
      energy.missing,
      run.report?.max_residual ?? Number.NaN,
      (ghost && !ghost.stopped ? ghost.report?.max_residual : undefined) ?? Number.NaN,
    ]);
  }

  private refresh(): void {
    const { run, controls } = this.session;
    if (!run) return;
    const { report, simulation } = run;
    const { clock, running } = this.playback;
    this.time = simulation.time;
    this.ratio = clock.ratio;
    this.late = running && clock.late;
    const choice = controls?.integrator === 'auto' ? report : null;
    this.chosen = choice?.integrator ?? null;
    this.tooStiff = choice?.too_stiff ?? null;
    this.solver = report?.solver ?? null;
    this.events = this.lastEvents;
    const wanted = this.termsOpen || this.selection !== null || !running;
    this.terms = wanted ? this.readTerms() : null;
    // the warnings of a paused state are those of the state and not of the last step
    if (!running && this.terms) this.warnings = [...this.startWarnings(), ...this.terms.warnings];
    else if (performance.now() - this.warnedMs > WARNING_STAYS_MS) this.warnings = [];
    this.tick += 1;
  }

  /** The note for the author of a scene whose start violated its constraints: the displacement of the start. */
  private startWarnings(): string[] {
    const simulation = this.session.run?.simulation;
    const projection = simulation?.projection();
    if (!simulation || !projection || simulation.time > 0) return [];
    const changes: string[] = [];
    if (projection.is_moved) changes.push(`positions by up to ${format(projection.moved)} m`);
    if (projection.is_turned) changes.push(`velocities by up to ${format(projection.velocity_changed)} m/s`);
    if (changes.length === 0) return [];
    return [
      `The start did not satisfy the constraints; it was changed so that it does: ${changes.join(', ')}.`,
    ];
  }

  private readTerms(): Terms | null {
    try {
      return this.session.run!.simulation.terms();
    } catch (error) {
      if (error instanceof EngineError) return null;
      throw error;
    }
  }
}
