// One simulation, stepped until the engine refuses a step; then the run keeps its last good state and the reason.

import { type Controls, defaultFrameWork, EngineError, Simulation, type StepReport } from '../engine';

/**
 * Limit of row solves in a frame for auto on the page. The engine's default allows a tenth of a second and more for a
 * frame, which suits a run that is written to a file. On the page a frame must take at most sixteen milliseconds.
 */
const FRAME_WORK = 1_000_000;

/** Limits the work of a frame, unless the scene has a limit of its own. */
function limit(simulation: Simulation): void {
  const controls = simulation.controls();
  if (controls.frame_work === defaultFrameWork()) {
    simulation.setControls({ ...controls, frame_work: FRAME_WORK });
  }
}

export class Run {
  /** why the run stopped: the message of the engine; null while the run can go on */
  stopped: EngineError | null = null;
  report: StepReport | null = null;
  /** T + V minus the energy supplied, at the start, in J: the energy error is counted from this balance */
  private balance: number;

  private constructor(readonly simulation: Simulation) {
    this.balance = simulation.energy().balance;
  }

  /** The energy parts as plotted, J. */
  energy(): { kinetic: number; potential: number; total: number; missing: number } {
    const { kinetic, potential, total, balance } = this.simulation.energy();
    return { kinetic, potential, total, missing: balance - this.balance };
  }

  /** Throws EngineError if the text is no scene. */
  static open(text: string, sourceName: string): Run {
    const simulation = new Simulation(text, sourceName);
    limit(simulation);
    return new Run(simulation);
  }

  /** A second run of the same scene with its own controls, from the scene's start. */
  beside(controls: Controls): Run {
    const { text, sourceName } = this.simulation;
    const run = Run.open(text, sourceName);
    try {
      const parameters = this.simulation.parameters();
      if (parameters.length > 0) run.bind(parameters.map(({ value }) => value));
      run.simulation.setControls(controls);
    } catch (error) {
      run.close();
      throw error;
    }
    return run;
  }

  /** One step of h; false if the run has stopped. */
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

  /** Gives the parameters of the scene new values, and goes to the start that follows from them, with its controls. */
  bind(values: readonly number[]): void {
    this.simulation.bind(values);
    limit(this.simulation);
    this.stopped = null;
    this.report = null;
    this.balance = this.simulation.energy().balance;
  }

  /** Returns to the start of the motion with the present controls. */
  reset(): void {
    this.stopped = null;
    this.report = null;
    try {
      this.simulation.reset();
      this.balance = this.simulation.energy().balance;
    } catch (error) {
      // the integrator chosen in the meantime cannot make this start consistent
      if (!(error instanceof EngineError)) throw error;
      this.stopped = error;
    }
  }

  close(): void {
    this.simulation.free();
  }
}
