// The only file that imports WebAssembly. The rest of the page uses the class below and plain records.

import start, {
  type Controls,
  default_frame_work,
  type Energy,
  type Structure as EngineStructure,
  type InitOutput,
  type IntegratorFacts,
  integrators as integratorFacts,
  type Link,
  type Parameter,
  type Projection,
  type Shape,
  type Shipped,
  type StepReport,
  shipped_scenes,
  type Terms,
  Simulation as WasmSimulation,
} from './wasm/qhat_wasm.js';

export type {
  Controls,
  Energy,
  FormulationName,
  IntegratorFacts,
  IntegratorName,
  Link,
  Parameter,
  Projection,
  Shape,
  ShapeKind,
  Shipped,
  Source,
  StepEvent,
  StepReport,
  Terms,
} from './wasm/qhat_wasm.js';

/** A shape with a tension: a rod, a rope or a strut. */
export type LinkShape = Shape & { link: Link };

/** The parts of a scene. Rows and names of rows change with the formulation, driven shapes with time. */
export interface Structure extends EngineStructure {
  /** the rods, ropes and struts among the shapes, in the order of `tension()` */
  links: LinkShape[];
}

/** A refusal of the engine with its message; `kind` is the type of the Rust error. */
export class EngineError extends Error {
  constructor(
    readonly kind: string,
    message: string,
  ) {
    super(message);
    this.name = 'EngineError';
  }
}

let ready: Promise<InitOutput> | undefined;

/** Fetches and compiles the engine, once. */
export function startEngine(): Promise<InitOutput> {
  ready ??= start();
  return ready;
}

export function integrators(): IntegratorFacts[] {
  return integratorFacts();
}

/** Row solves a frame that auto may take where a scene sets no limit. */
export function defaultFrameWork(): number {
  return default_frame_work();
}

export function shippedScenes(): Shipped[] {
  return shipped_scenes();
}

/** One running scene: converts errors, and frees the engine's memory, which JavaScript does not collect. */
export class Simulation {
  private readonly inner: WasmSimulation;

  constructor(
    readonly text: string,
    readonly sourceName: string,
  ) {
    this.inner = attempt(() => new WasmSimulation(text, sourceName));
  }

  structure(): Structure {
    const structure = this.inner.structure();
    return { ...structure, links: structure.shapes.filter(isLink) };
  }

  parameters(): Parameter[] {
    return this.inner.parameters();
  }

  /** Gives the parameters new values, in their order, and goes back to the start that follows from them. */
  bind(values: readonly number[]): void {
    attempt(() => this.inner.bind(Float64Array.from(values)));
  }

  /** The shapes of the scene at a time in s; the engine is asked for driven shapes only. */
  shapesAt(shapes: Shape[], time: number): Shape[] {
    if (!shapes.some(({ driven }) => driven)) return shapes;
    const moved = this.inner.driven_shapes(time).values();
    return shapes.map((shape) => (shape.driven ? (moved.next().value ?? shape) : shape));
  }

  get time(): number {
    return this.inner.time();
  }

  /** m, flat; a copy */
  positions(): Float64Array {
    return this.inner.positions();
  }

  /** m/s, flat; a copy */
  velocities(): Float64Array {
    return this.inner.velocities();
  }

  /** N, one for each link: positive if it pulls its ends together, 0 while slack */
  tension(): Float64Array {
    return attempt(() => this.inner.tension());
  }

  /** The indices of the broken links. */
  broken(): Uint32Array {
    return this.inner.broken();
  }

  energy(): Energy {
    return attempt(() => this.inner.energy());
  }

  terms(): Terms {
    return attempt(() => this.inner.terms());
  }

  /** The displacement of the start that satisfied the constraints. */
  projection(): Projection {
    return this.inner.projection();
  }

  /** One step of h. */
  step(): StepReport {
    return attempt(() => this.inner.step());
  }

  reset(): void {
    attempt(() => this.inner.reset());
  }

  controls(): Controls {
    return this.inner.controls();
  }

  setControls(controls: Controls): void {
    attempt(() => this.inner.set_controls(controls));
  }

  /** Ties a particle to a target in m by a mouse spring; the engine scales its stiffness by the mass. */
  grab(particle: number, target: readonly number[]): void {
    attempt(() => this.inner.grab(particle, Float64Array.from(target)));
  }

  dragTo(target: readonly number[]): void {
    attempt(() => this.inner.drag_to(Float64Array.from(target)));
  }

  release(): void {
    this.inner.release();
  }

  free(): void {
    this.inner.free();
  }
}

export function isLink(shape: Shape): shape is LinkShape {
  return shape.link !== null;
}

function attempt<T>(call: () => T): T {
  try {
    return call();
  } catch (error) {
    if (error instanceof Error) throw new EngineError(error.name, error.message);
    throw new EngineError('Error', String(error));
  }
}
