// The scene that is open: its text, its structure, its run and its controls. Playback, comparison, hand and readings
// are parts of their own, which listen to the signals below.

import {
  type Controls,
  type IntegratorFacts,
  integrators,
  type Parameter,
  type Shipped,
  type Structure,
  shippedScenes,
  startEngine,
} from '../engine';
import { sceneInAddress, type Values, valuesInAddress } from './address';
import { downOf, type NumberControl, withControl } from './controls';
import { DEFAULT_SCENE } from './gallery';
import { Run } from './run';
import { type SceneSource, sceneFromCommand, shipped } from './scenes';
import { Signal } from './signal';

export type Phase = 'starting' | 'ready' | 'failed';

export class Session {
  phase = $state<Phase>('starting');
  /** why there is no scene: the message of the engine */
  failure = $state<string | null>(null);
  scenes = $state.raw<Shipped[]>([]);
  integrators = $state.raw<IntegratorFacts[]>([]);
  source = $state.raw<SceneSource | null>(null);
  structure = $state.raw<Structure | null>(null);
  controls = $state.raw<Controls | null>(null);
  /** the controls as the scene sets them: the values to which a control is reset */
  original = $state.raw<Controls | null>(null);
  parameters = $state.raw<Parameter[]>([]);
  /** the parameters as the scene sets them */
  originalParameters = $state.raw<Parameter[]>([]);
  /** the control that the engine refused last, and the message */
  refusal = $state.raw<{ key: string; message: string } | null>(null);
  run: Run | null = null;

  /** The run is about to end; runs beside it end with it. */
  readonly closing = new Signal();
  /** The engine failed: its memory must not be used again. */
  readonly crashed = new Signal();
  /** Another scene is open, at its start. */
  readonly opened = new Signal();
  /** The scene has other parameters, and is at the start that follows from them. */
  readonly bound = new Signal();
  /** The run took these controls; a listener that throws an `EngineError` makes it a refusal. */
  readonly controlsTaken = new Signal<[Controls]>();
  /** The controls were set or refused; the fields above say which. */
  readonly controlsSettled = new Signal();

  /** The direction of gravity, a unit vector. */
  get down(): number[] {
    return downOf(this.original?.gravity ?? [], this.structure?.dimension ?? 2);
  }

  /** Whether an integrator holds the constraints by projection and therefore ignores ks, kd, ε and e. */
  projects(integrator: Controls['integrator'] | undefined): boolean {
    return this.integrators.some(({ name, projects }) => projects && name === integrator);
  }

  async start(): Promise<void> {
    try {
      await startEngine();
    } catch (error) {
      this.fail(`The engine could not be started: ${String(error)}`);
      return;
    }
    this.scenes = shippedScenes();
    this.integrators = integrators();
    await this.openAddress();
  }

  /** Opens the scene in the address, else the scene that the command was given, else the default. */
  async openAddress(): Promise<void> {
    const [name, values] = [sceneInAddress(location), valuesInAddress(location)];
    if (name !== null) this.openNamed(name, values);
    else this.open((await sceneFromCommand()) ?? shipped(DEFAULT_SCENE)!, values);
  }

  openNamed(name: string, values: Values = {}): void {
    const source = shipped(name);
    if (source) this.open(source, values);
    else this.fail(`No scene is called “${name}”. The list above has every scene.`);
  }

  open(source: SceneSource, values: Values = {}): void {
    let run: Run;
    let original: Parameter[];
    try {
      run = Run.open(source.text, source.fileName);
      original = run.simulation.parameters();
      try {
        if (Object.keys(values).length > 0) run.bind(withValues(original, values));
      } catch (error) {
        run.close();
        throw error;
      }
    } catch (error) {
      this.fail(messageOf(error));
      this.source = source;
      return;
    }
    this.close();
    this.originalParameters = original;
    this.parameters = run.simulation.parameters();
    this.run = run;
    this.source = source;
    this.failure = null;
    this.refusal = null;
    this.structure = run.simulation.structure();
    this.controls = run.simulation.controls();
    this.original = this.controls;
    this.phase = 'ready';
    this.opened.send();
  }

  /** An unexpected error: the page shows it and stays usable. */
  crash(error: unknown): void {
    this.run = null;
    this.crashed.send();
    this.fail(`The engine broke off: ${String(error)}. Please report the scene.`);
  }

  private fail(message: string): void {
    this.close();
    this.source = null;
    this.structure = null;
    this.failure = message;
    this.phase = 'failed';
  }

  private close(): void {
    this.closing.send();
    this.run?.close();
    this.run = null;
  }

  set(key: NumberControl, value: number): void {
    if (this.controls) this.apply(key, withControl(this.controls, key, value, this.down));
  }

  setIntegrator(integrator: Controls['integrator']): void {
    if (this.controls) this.apply('integrator', { ...this.controls, integrator });
  }

  setFormulation(formulation: Controls['formulation']): void {
    if (this.controls) this.apply('formulation', { ...this.controls, formulation });
  }

  /** Gives a parameter a value. The controls keep what a person has changed. */
  setParameter(name: string, value: number): void {
    const { run } = this;
    if (!run || !this.controls || !this.original) return;
    const changed = changes(this.original, this.controls);
    const refuse = (error: unknown) => {
      this.refusal = { key: `parameter-${name}`, message: messageOf(error) };
    };
    try {
      run.bind(withValues(this.parameters, { [name]: value }));
    } catch (error) {
      refuse(error);
      return;
    }
    this.refusal = null;
    this.original = run.simulation.controls();
    try {
      run.simulation.setControls({ ...this.original, ...changed });
    } catch (error) {
      // a control that a person has changed does not go with the value
      refuse(error);
      run.bind(withValues(this.parameters, {}));
      this.original = run.simulation.controls();
      run.simulation.setControls({ ...this.original, ...changed });
    }
    this.parameters = run.simulation.parameters();
    this.structure = run.simulation.structure();
    this.controls = run.simulation.controls();
    this.bound.send();
  }

  /** The values of parameters that differ from those of the scene. */
  get changedParameters(): Values {
    const own = new Map(this.originalParameters.map(({ name, value }) => [name, value]));
    const changed = this.parameters.filter(({ name, value }) => own.get(name) !== value);
    return Object.fromEntries(changed.map(({ name, value }) => [name, value]));
  }

  private apply(key: string, controls: Controls): void {
    if (!this.run) return;
    try {
      this.run.simulation.setControls(controls);
      this.controlsTaken.send(controls);
      this.refusal = null;
    } catch (error) {
      this.refusal = { key, message: messageOf(error) };
    }
    this.controls = this.run.simulation.controls();
    // the classic nail has one row where the modern nail has two or three
    if (key === 'formulation') this.structure = this.run.simulation.structure();
    this.controlsSettled.send();
  }
}

/** The message of an error. */
export function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** The values of parameters, some of them changed. Throws where a name is unknown or a value is no number. */
function withValues(parameters: readonly Parameter[], values: Values): number[] {
  for (const [name, value] of Object.entries(values)) {
    if (!parameters.some((parameter) => parameter.name === name)) {
      const names = parameters.map((parameter) => `“${parameter.name}”`).join(', ');
      const known =
        names === '' ? 'this scene has no parameters' : `the parameters of this scene are ${names}`;
      throw new Error(`No parameter is called “${name}”: ${known}.`);
    }
    if (Number.isNaN(value)) throw new Error(`The value of the parameter “${name}” is no number.`);
  }
  return parameters.map(({ name, value }) => (Object.hasOwn(values, name) ? values[name] : value));
}

/** The controls that differ from the original ones. */
function changes(original: Controls, controls: Controls): Partial<Controls> {
  const keys = Object.keys(controls) as (keyof Controls)[];
  const changed = keys.filter((key) => String(controls[key]) !== String(original[key]));
  return Object.fromEntries(changed.map((key) => [key, controls[key]]));
}
