// Pulls the selected particle with the arrow keys, as a hand that moves in the plane of the screen.

import type { Hand } from '../session/hand';
import type { Stage } from './stage';

export class ArrowHand {
  /** the position of the particle when the keys grabbed it, in m, and the position of the hand, in px */
  private pull: { anchor: number[]; x: number; y: number } | null = null;

  constructor(
    private readonly hand: Hand,
    private readonly stage: Stage,
  ) {}

  /** Moves the hand by a distance in px; the first move grabs the particle. */
  move(particle: number, dx: number, dy: number): void {
    const { camera } = this.stage;
    if (!this.pull) {
      const anchor = this.stage.positionOf(particle);
      const screen = [0, 0, 0];
      camera.project(anchor, 0, screen);
      this.pull = { anchor, x: screen[0], y: screen[1] };
    }
    this.pull.x += dx;
    this.pull.y += dy;
    const target = camera.unproject(this.pull.x, this.pull.y, this.pull.anchor);
    if (this.hand.held) this.hand.dragTo(target);
    else this.hand.grab(particle, target);
  }

  release(): void {
    if (!this.pull) return;
    this.pull = null;
    this.hand.release();
  }
}
