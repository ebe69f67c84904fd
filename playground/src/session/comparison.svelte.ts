// The ghost: a second run of the scene by another method, beside the first.

import type { Controls } from '../engine';
import type { Run } from './run';
import { messageOf, type Session } from './session.svelte';
import { Signal } from './signal';

export class Comparison {
  on = $state(false);
  integrator = $state<Controls['integrator']>('euler');
  formulation = $state<Controls['formulation']>('modern');
  /** why the ghost stopped or could not start: the message of the engine */
  stopped = $state.raw<string | null>(null);
  ghost: Run | null = null;

  /** The ghost was added, changed or removed. Both runs start again, so that they differ by the method alone. */
  readonly changed = new Signal();

  constructor(private readonly session: Session) {
    session.opened.listen(() => this.begin());
    session.closing.listen(() => this.close());
    session.crashed.listen(() => {
      this.ghost = null;
    });
    session.controlsTaken.listen((controls) => this.ghost?.simulation.setControls(this.controlsOf(controls)));
  }

  private begin(): void {
    this.on = false;
    this.stopped = null;
    this.integrator = this.session.controls?.integrator === 'euler' ? 'auto' : 'euler';
    this.formulation = 'modern';
  }

  private close(): void {
    this.ghost?.close();
    this.ghost = null;
  }

  /** The controls of the ghost: the controls of the run, with the method of the ghost. */
  private controlsOf(controls: Controls): Controls {
    return { ...controls, integrator: this.integrator, formulation: this.formulation };
  }

  setOn(on: boolean): void {
    this.on = on;
    this.close();
    const { run, controls } = this.session;
    if (!run || !controls) return;
    if (on) {
      try {
        this.ghost = run.beside(this.controlsOf(controls));
      } catch (error) {
        this.stopped = messageOf(error);
        return;
      }
    }
    this.changed.send();
  }

  setMethod(integrator: Controls['integrator'], formulation: Controls['formulation']): void {
    this.integrator = integrator;
    this.formulation = formulation;
    if (this.on) this.setOn(true);
  }

  /** A new ghost of the run, whose parameters have changed. */
  rebuild(): void {
    const { run, controls } = this.session;
    this.close();
    if (!this.on || !run || !controls) return;
    try {
      this.ghost = run.beside(this.controlsOf(controls));
      this.stopped = null;
    } catch (error) {
      this.stopped = messageOf(error);
    }
  }

  reset(): void {
    this.ghost?.reset();
    this.stopped = this.ghost?.stopped?.message ?? null;
  }

  /** One step of the ghost, which may stop before the run does. */
  step(): void {
    if (this.ghost && !this.ghost.stopped && !this.ghost.step()) this.stopped = this.ghost.stopped!.message;
  }
}
