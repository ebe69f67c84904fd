// window.qhat: the page's public handle, for people at the console of the browser and for the tests of the page. It
// gives copies, and its methods have the same effect as the buttons.
//
//   qhat.state()            time, positions, velocities, tension, max |C| of the run and of the ghost
//   qhat.terms()            every symbol of this state: J, A, λ, b, …
//   qhat.controls()         the values of the controls
//   qhat.pause(); qhat.step(100); qhat.reset(); qhat.play()
//   qhat.screen(3)          where particle 3 is on the canvas, px

import type { Controls, StepReport, Structure, Terms } from './engine';
import type { Page } from './page';

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
  /** true once there is a scene, or a message why there is none */
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

export function installHandle({ session, comparison, playback, stage }: Page): void {
  window.qhat = {
    get ready() {
      return session.phase !== 'starting';
    },
    state() {
      const { run } = session;
      const { ghost } = comparison;
      const simulation = run?.simulation;
      return {
        time: simulation?.time ?? 0,
        running: playback.running,
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
    play: () => playback.play(),
    pause: () => playback.pause(),
    step(count = 1) {
      for (let k = 0; k < count && !playback.stopped; k += 1) playback.stepOnce();
    },
    reset: () => playback.reset(),
    screen(particle) {
      const at = [0, 0, 0];
      stage.camera.project(stage.positionOf(particle), 0, at);
      return [at[0], at[1]];
    },
  };
}
