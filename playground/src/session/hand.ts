// The hand that pulls a particle with a spring, on both runs.

import type { Comparison } from './comparison.svelte';
import type { Session } from './session.svelte';

export interface Held {
  particle: number;
  /** where the hand is, m */
  target: number[];
}

export class Hand {
  /** the particle that is pulled; null for an empty hand */
  held: Held | null = null;

  constructor(
    private readonly session: Session,
    private readonly comparison: Comparison,
  ) {
    // the spring ends with its run
    session.closing.listen(() => {
      this.held = null;
    });
  }

  /** Takes hold of a particle that can move; the target is in m. */
  grab(particle: number, target: number[]): void {
    const { run, structure } = this.session;
    if (!run || structure?.fixed[particle]) return;
    run.simulation.grab(particle, target);
    this.comparison.ghost?.simulation.grab(particle, target);
    this.held = { particle, target };
  }

  dragTo(target: number[]): void {
    if (!this.held) return;
    this.session.run?.simulation.dragTo(target);
    this.comparison.ghost?.simulation.dragTo(target);
    this.held = { ...this.held, target };
  }

  release(): void {
    if (!this.held) return;
    this.session.run?.simulation.release();
    this.comparison.ghost?.simulation.release();
    this.held = null;
  }
}
