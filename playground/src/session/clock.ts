// Turns wall time into steps of h. Simulated time follows wall time × speed. Steps for which a frame has no time are
// dropped and the page says so, because steps owed to the next frame would make the next frame later still.

export interface ClockReading {
  /** steps taken in this animation frame */
  steps: number;
  /** how far the wall clock is between the last step and the next one, in [0, 1] */
  fraction: number;
}

/** The wall time a frame may spend stepping; the rest of 16.7 ms is for drawing and the browser. */
const STEP_BUDGET_MS = 10;

/** A frame later than this, in s, comes from a page that was hidden and not from slow steps: the rest is dropped. */
const LONGEST_FRAME_S = 0.1;

/** Weight of the newest frame in the running ratio: about half a second of memory at 60 frames a second. */
const RATIO_WEIGHT = 1 / 30;

export class RealTimeClock {
  speed = 1;
  private owed = 0;
  private lastMs: number | null = null;
  private asked = 0;
  private done = 0;

  constructor(
    private readonly now: () => number,
    private readonly budgetMs = STEP_BUDGET_MS,
  ) {}

  /** Simulated seconds per wall second over the last half second, relative to the chosen speed; 1 is on time. */
  get ratio(): number {
    return this.asked > 0 ? this.done / this.asked : 1;
  }

  /** True if the page cannot hold the chosen speed. */
  get late(): boolean {
    // an eye does not notice 5 %, and one step more or less in a frame makes less than 5 %
    return this.asked > 0 && this.ratio < 0.95;
  }

  /** Ignores the time that passed while the run was paused. */
  restart(): void {
    this.lastMs = null;
    this.owed = 0;
    this.asked = 0;
    this.done = 0;
  }

  /** Runs the steps that are due at `timeMs`; `step` returns false to stop. */
  frame(timeMs: number, h: number, step: () => boolean): ClockReading {
    const elapsed = this.lastMs === null ? 0 : Math.max(0, (timeMs - this.lastMs) / 1000);
    this.lastMs = timeMs;
    const asked = Math.min(elapsed, LONGEST_FRAME_S) * this.speed;
    this.owed += asked;

    const began = this.now();
    let steps = 0;
    while (this.owed >= h) {
      if (!step()) break;
      this.owed -= h;
      steps += 1;
      if (this.now() - began >= this.budgetMs) break;
    }
    const given = this.owed >= h ? Math.floor(this.owed / h) * h : 0;
    this.owed -= given;
    this.asked += (asked - this.asked) * RATIO_WEIGHT;
    this.done += (asked - given - this.done) * RATIO_WEIGHT;
    return { steps, fraction: Math.min(1, this.owed / h) };
  }
}
