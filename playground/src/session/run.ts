// One simulation that is stepped until it says it cannot go on; then it keeps its last good state and the reason.

import { type Controls, defaultFrameWork, EngineError, Simulation, type StepReport } from '../engine';

/**
 * Row solves a frame of auto on the page. The engine's own default waits up to a tenth of a second a frame and more,
 * which is right for a file that is written once; a hand on the mouse needs its frame in sixteen milliseconds.
 */
const FRAME_WORK = 1_000_000;

export class Run {
  /** why it stopped, in the engine's words; null while it goes */
  stopped: EngineError | null = null;
  report: StepReport | null = null;
  /** T + V less what came in, at the start, J: what is missing later is measured from here */
  private balance: number;

  private constructor(readonly simulation: Simulation) {
    this.balance = simulation.energy().balance;
  }

  /** The energy parts as plotted, J. */
  energy(): { kinetic: number; potential: number; total: number; missing: number } {
    const { kinetic, potential, total, balance } = this.simulation.energy();
    return { kinetic, potential, total, missing: balance - this.balance };
  }

  /** Throws EngineError where the text is no scene. */
  static open(text: string, sourceName: string): Run {
    const simulation = new Simulation(text, sourceName);
    const controls = simulation.controls();
    // a scene that sets its own has its reasons
    if (controls.frame_work === defaultFrameWork()) {
      simulation.setControls({ ...controls, frame_work: FRAME_WORK });
    }
    return new Run(simulation);
  }

  /** A second run of the same scene with its own controls, from the scene's start. */
  beside(controls: Controls): Run {
    const { text, sourceName } = this.simulation;
    const run = Run.open(text, sourceName);
    try {
      run.simulation.setControls(controls);
    } catch (error) {
      run.close();
      throw error;
    }
    return run;
  }

  /** One step of h; false where it has stopped. */
  step(): boolean {
    if (this.stopped) return false;
    try {
      this.report = this.simulation.step();
      return true;
    } catch (error) {
      if (!(error instanceof EngineError)) throw error;
      this.stopped = error;
      return false;
    }
  }

  /** Back to the start of the motion, under the controls as they are now. */
  reset(): void {
    this.stopped = null;
    this.report = null;
    try {
      this.simulation.reset();
      this.balance = this.simulation.energy().balance;
    } catch (error) {
      // a start that the integrator chosen since cannot make consistent
      if (!(error instanceof EngineError)) throw error;
      this.stopped = error;
    }
  }

  close(): void {
    this.simulation.free();
  }
}
