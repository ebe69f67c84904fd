// Time: playing, pausing, stepping, speed and reset of both runs.

import type { EngineError, StepReport } from '../engine';
import { RealTimeClock } from './clock';
import type { Comparison } from './comparison.svelte';
import type { Hand } from './hand';
import type { Session } from './session.svelte';
import { Signal } from './signal';

/** Simulated seconds in a second of wall time. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export class Playback {
  running = $state(false);
  speed = $state(1);
  /** why the run stopped at its last good state */
  stopped = $state.raw<EngineError | null>(null);
  /** how far the wall clock is between the last step and the next one, in [0, 1] */
  fraction = 1;
  readonly clock = new RealTimeClock(() => performance.now());

  /** The runs are at their start. */
  readonly restarted = new Signal();
  /** The run took one step. */
  readonly stepped = new Signal<[StepReport]>();
  /** The runs moved: all steps of an animation frame, or a single one, are done. */
  readonly moved = new Signal();
  /** The runs are paused, by a person or because the run stopped. */
  readonly halted = new Signal();

  constructor(
    private readonly session: Session,
    private readonly comparison: Comparison,
    private readonly hand: Hand,
  ) {
    session.opened.listen(() => {
      // if the system is set to less motion, a person starts the scene
      this.running = !matchMedia('(prefers-reduced-motion: reduce)').matches;
      this.begin();
    });
    session.closing.listen(() => {
      this.running = false;
      this.stopped = null;
    });
    comparison.changed.listen(() => this.reset());
    session.bound.listen(() => {
      hand.release();
      comparison.rebuild();
      this.begin();
    });
  }

  play(): void {
    if (!this.session.run || this.stopped) return;
    this.clock.restart();
    this.running = true;
  }

  pause(): void {
    this.running = false;
    this.fraction = 1;
    this.halted.send();
  }

  toggle(): void {
    if (this.running) this.pause();
    else this.play();
  }

  stepOnce(): void {
    if (!this.session.run) return;
    this.running = false;
    this.fraction = 1;
    if (this.advance()) this.moved.send();
    this.halted.send();
  }

  reset(): void {
    const { run } = this.session;
    if (!run) return;
    this.hand.release();
    run.reset();
    this.comparison.reset();
    this.begin();
  }

  private begin(): void {
    this.stopped = this.session.run?.stopped ?? null;
    if (this.stopped) this.running = false;
    this.clock.restart();
    this.fraction = 1;
    this.restarted.send();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.clock.speed = speed;
    this.clock.restart();
  }

  /** The next larger or smaller of the speeds. */
  changeSpeed(by: 1 | -1): void {
    const index = SPEEDS.findIndex((speed) => speed >= this.speed);
    this.setSpeed(SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, index + by))]);
  }

  /** The steps that are due at a wall time in ms. */
  frame(timeMs: number): void {
    const { run, controls } = this.session;
    if (!run || !controls || !this.running) return;
    const reading = this.clock.frame(timeMs, controls.h, () => this.advance());
    this.fraction = this.stopped ? 1 : reading.fraction;
    if (reading.steps > 0) this.moved.send();
    if (this.stopped) this.halted.send();
  }

  /** One step of both runs; false if the run has stopped. */
  private advance(): boolean {
    const run = this.session.run!;
    if (!run.step()) {
      this.running = false;
      this.stopped = run.stopped;
      return false;
    }
    this.stepped.send(run.report!);
    this.comparison.step();
    return true;
  }
}
