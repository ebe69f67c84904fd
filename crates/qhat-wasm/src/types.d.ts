// The records that the engine and the page exchange. Field names, and in Terms also their order, are the same as in the
// Rust structs. Arrays are flat, particle after particle: x1 y1 x2 y2 …; SI units.

export type IntegratorName =
  | 'auto'
  | 'euler'
  | 'symplectic-euler'
  | 'rk4'
  | 'rattle'
  | 'dopri5'
  | 'dop853'
  | 'radau5'
  | 'implicit'
  | 'bdf2';
/** The way in which the constraints were solved. */
export type SolverName = 'rows' | 'lanes' | 'end of step';
/** `mixed`: the constraints of a scene have different formulations */
export type FormulationName = 'modern' | 'classic' | 'mixed';

export interface IntegratorFacts {
  name: IntegratorName;
  /** holds C = 0 and Ċ = 0 itself, and uses none of ks, kd, diagonal drag and elasticity */
  projects: boolean;
  /** chooses its own substeps within a frame of h */
  adaptive: boolean;
}

/** A scene that ships with qhat. */
export interface Shipped {
  name: string;
  title: string;
  /** the heading under which a list shows it; scenes of a group follow each other */
  group: string;
  text: string;
}

/** The kind of a shape. In brackets: its particles, then its points, then its size in m. */
export type ShapeKind =
  /** holds one length [a, b; ; length] */
  | 'rod'
  /** taut at its length, slack at less [a, b; ; length] */
  | 'rope'
  /** pushes at its shortest length, loose at more, up to its longest length if it has one [a, b; ; shortest length] */
  | 'strut'
  /** a rod whose length or other end is driven [a, b; ; length] or [a; b; length] */
  | 'driven-rod'
  /** a piece of a rope over pulleys [a, b; ; 0] */
  | 'cord'
  /** a constraint couples the two, without a solid part between them [a, b; ; 0] */
  | 'tie'
  /** a spring, linear or not [a, b; ; rest length] */
  | 'spring'
  /** a push and pull along the line of two particles [a, b; ; 0] */
  | 'actuator'
  /** holds a particle to a point; driven or not [particle; point; 0] */
  | 'nail'
  /** a curve in the scene [; its points in order; 0] */
  | 'wire'
  /** an endless straight line [a, b], [a; direction] or [; point, direction] */
  | 'line'
  /** a circle across an axis [centre; axis; radius] or [; centre, axis; radius] */
  | 'ring'
  /** a ball; particles stay outside [; centre; radius] */
  | 'ball'
  /** a sphere; particles stay inside or on it [; centre; radius] */
  | 'bowl'
  /** particles stay above it [; point, unit normal] */
  | 'ground'
  /** a box; particles stay outside [; centre, half its size] */
  | 'box'
  /** the angle from the arm a-b, or from a direction, to the arm c-d [a, b, c, d] or [c, d; direction] */
  | 'angle'
  /** the pitch circle of a wheel [centre, a point of it; ; radius] */
  | 'wheel'
  /** a filled polygon [its corners in order] */
  | 'area'
  /** an endless plane [; point, normal] */
  | 'plane';

/** The constraint or force that a shape belongs to, with its index among the constraints or forces of the scene. */
export interface Source {
  list: 'constraint' | 'force';
  index: number;
}

/** The further fields of a shape with a tension (rod, rope, strut). */
export interface Link {
  /** its index in `tension()` and in `Terms.tension`, and its number in `broken()` */
  place: number;
  /** the least distance of its ends, m; null for a rope */
  shortest: number | null;
  /** the largest distance of its ends, m; null for a loose strut; a rod has its length in both fields */
  longest: number | null;
  /** the indices of its multipliers; with two limits, the longest comes first */
  rows: number[];
}

/** One thing to draw: links, nails, springs, surfaces, curves, wheels, … */
export interface Shape {
  kind: ShapeKind;
  of: Source;
  /** the name of its constraint; '' for a force */
  name: string;
  particles: number[];
  /** m, three numbers each */
  points: Float64Array;
  /** m */
  size: number;
  /** whether its points and its size change with t */
  driven: boolean;
  /** for rods, ropes and struts, in the order of `tension()`; null for all other shapes */
  link: Link | null;
}

/** The parts of a scene, which do not change while it runs. */
export interface Structure {
  name: string;
  description: string;
  dimension: 2 | 3;
  /** the intended time of a run, s */
  duration: number;
  particle_names: string[];
  row_names: string[];
  /** kg */
  masses: Float64Array;
  fixed: boolean[];
  /** everything to draw; driven shapes as they are at the present time */
  shapes: Shape[];
}

/** A named number of a scene. */
export interface Parameter {
  name: string;
  value: number;
  /** null: no limit */
  min: number | null;
  max: number | null;
  /** may be empty */
  unit: string;
}

/** The values of all controls of the page. */
export interface Controls {
  /** s */
  h: number;
  integrator: IntegratorName;
  /** for implicit and bdf2: most Newton iterations in a frame */
  frame_budget: number;
  /** for auto: row solves in a frame after which it changes to bdf2 */
  frame_work: number;
  formulation: FormulationName;
  /** 1/s² */
  ks: number;
  /** 1/s */
  kd: number;
  /** unit of A */
  diagonal_drag: number;
  /** in [0, 1): Q̂ is scaled by 1 − elasticity */
  elasticity: number;
  /** m/s², always three numbers */
  gravity: number[];
  /** N·s/m */
  drag: number;
}

/** J */
export interface Energy {
  kinetic: number;
  potential: number;
  total: number;
  /** T + V minus the energy supplied since the start: constant for an exact integrator */
  balance: number;
}

/** An event: a change at one moment. */
export interface StepEvent {
  /** `impact`: hit above the rest speed; `closed`, `opened`: acts, or does not act, from now on; `broke`: for good */
  kind: 'impact' | 'closed' | 'opened' | 'slipped' | 'stuck' | 'broke';
  /** the name of the constraint */
  constraint: string;
  /** s */
  time: number;
  /** for an impact: the closing speed, m/s */
  speed?: number;
}

export interface StepReport {
  substeps: number;
  rejected: number;
  factorizations: number;
  iterations: number;
  /** s */
  smallest_substep: number;
  max_residual: number;
  max_residual_rate: number;
  max_relative_length_error: number;
  /** the largest tension (positive) or thrust, N, with its constraint and time, s; null if it is not recorded;
   * is_unique is false if redundant links could carry the load in other ways */
  max_tension: { tension: number; constraint: number; time: number; is_unique: boolean } | null;
  energy: Energy;
  /** the integrator of this step; with auto, the integrator that auto chose */
  integrator: IntegratorName;
  solver: SolverName;
  /** the events of the step, in the order of time */
  events: StepEvent[];
  /** the reason for which auto changed to bdf2; null if it did not */
  too_stiff: string | null;
  warnings: string[];
}

/** The projection that brought the start onto C = 0 and Ċ = 0. */
export interface Projection {
  /** the largest displacement of a particle, m; 0 if the start was consistent */
  moved: number;
  /** m/s */
  velocity_changed: number;
  /** whether `moved` is more than the tolerance explains */
  is_moved: boolean;
  /** whether `velocity_changed` is more than the tolerance explains */
  is_turned: boolean;
  residual_before: number;
  iterations: number;
}

/** Every symbol of one evaluation, in the order of computation. */
export interface Terms {
  /** s */
  time: number;
  positions: Float64Array;
  velocities: Float64Array;
  inverse_masses: Float64Array;
  applied_forces: Float64Array;
  residual: Float64Array;
  residual_rate: Float64Array;
  /** m × N, row after row; null if the system is too large to show */
  jacobian: Float64Array | null;
  acceleration_bias: Float64Array;
  /** m × m, row after row, before ε; null if the system is too large to show */
  constraint_matrix: Float64Array | null;
  rhs_bias: Float64Array;
  rhs_forces: Float64Array;
  rhs_stiffness: Float64Array;
  rhs_damping: Float64Array;
  right_hand_side: Float64Array;
  multipliers: Float64Array;
  constraint_forces: Float64Array;
  accelerations: Float64Array;
  /** N, one for each link: positive if it pulls its ends together, 0 while slack */
  tension: Float64Array;
  /** one for each link: false if redundant links could carry the load in other ways */
  tension_is_unique: boolean[];
  /** one for each row: false if redundant rows could exert the force in other ways */
  multiplier_is_unique: boolean[];
  /** one for each row: true if the row is inactive (an open contact, a broken constraint) */
  is_open: boolean[];
  /** the rank of A; null if A is singular and too large to count its rank */
  rank: number | null;
  warnings: string[];
}
