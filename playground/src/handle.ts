// window.qhat: the page's public handle, for a curious person's console and for the page's own tests. Everything it
// gives is a copy; what it changes goes through the same doors as the buttons.
//
//   qhat.state()            time, positions, velocities, tension, max |C| of what is shown, and of the ghost
//   qhat.terms()            every symbol of this state: J, A, λ, b, …
//   qhat.controls()         what the controls are set to
//   qhat.pause(); qhat.step(100); qhat.reset(); qhat.play()
//   qhat.screen(3)          where particle 3 is on the canvas, px

import type { Controls, StepReport, Structure, Terms } from './engine';
import type { Session } from './session/session.svelte';
import type { Stage } from './view/stage';

export interface PageState {
  time: number;
  running: boolean;
  positions: number[];
  velocities: number[];
  tension: number[];
  report: StepReport | null;
  stopped: string | null;
  ghost: { time: number; positions: number[]; report: StepReport | null } | null;
}

export interface Handle {
  /** true once there is a scene, or words why there is none */
  readonly ready: boolean;
  state(): PageState;
  structure(): Structure | null;
  controls(): Controls | null;
  terms(): Terms | null;
  play(): void;
  pause(): void;
  step(count?: number): void;
  reset(): void;
  screen(particle: number): [number, number];
}

declare global {
  interface Window {
    qhat: Handle;
  }
}

export function installHandle(session: Session, stage: Stage): void {
  window.qhat = {
    get ready() {
      return session.phase !== 'starting';
    },
    state() {
      const { run, ghost } = session;
      const simulation = run?.simulation;
      return {
        time: simulation?.time ?? 0,
        running: session.running,
        positions: Array.from(simulation?.positions() ?? []),
        velocities: Array.from(simulation?.velocities() ?? []),
        tension: Array.from(simulation?.tension() ?? []),
        report: run?.report ?? null,
        stopped: run?.stopped?.message ?? null,
        ghost: ghost && {
          time: ghost.simulation.time,
          positions: Array.from(ghost.simulation.positions()),
          report: ghost.report,
        },
      };
    },
    structure: () => session.structure,
    controls: () => session.controls,
    terms: () => session.run?.simulation.terms() ?? null,
    play: () => session.play(),
    pause: () => session.pause(),
    step(count = 1) {
      for (let k = 0; k < count && !session.stopped; k += 1) session.stepOnce();
    },
    reset: () => session.reset(),
    screen(particle) {
      const at = [0, 0, 0];
      stage.camera.project(stage.positionOf(particle), 0, at);
      return [at[0], at[1]];
    },
  };
}
