// The records that cross the border between the engine and the page. Field names, and in Terms also their order, are
// those of the Rust structs; arrays are flat, particle after particle: x1 y1 x2 y2 …; SI units.

export type IntegratorName =
  | 'auto'
  | 'euler'
  | 'symplectic-euler'
  | 'rk4'
  | 'rattle'
  | 'dopri5'
  | 'dop853'
  | 'implicit'
  | 'bdf2';
/** By which path the constraints were solved. */
export type SolverName = 'rows' | 'lanes' | 'end of step';
/** `mixed`: a scene may write each constraint in the form it likes */
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

/** What a shape is drawn as. In brackets its particles, then its points, then its size in m. */
export type ShapeKind =
  /** one length [a, b; ; length] */
  | 'rod'
  /** taut at its length, slack below [a, b; ; length] */
  | 'rope'
  /** pushes at its length, loose beyond, to its other limit if it has one [a, b; ; shortest length] */
  | 'strut'
  /** a rod whose length or other end is driven [a, b; ; length] or [a; b; length] */
  | 'driven-rod'
  /** a piece of a rope over pulleys [a, b; ; 0] */
  | 'cord'
  /** belongs together, with nothing solid between [a, b; ; 0] */
  | 'tie'
  /** a spring, linear or not [a, b; ; rest length] */
  | 'spring'
  /** pushes and pulls by itself [a, b; ; 0] */
  | 'actuator'
  /** holds a particle to a point; driven or not [particle; point; 0] */
  | 'nail'
  /** a curve in the scene [; its points in order; 0] */
  | 'wire'
  /** endless [a, b], [a; direction] or [; point, direction] */
  | 'line'
  /** a circle across an axis [centre; axis; radius] or [; centre, axis; radius] */
  | 'ring'
  /** filled, to be stayed out of [; centre; radius] */
  | 'ball'
  /** to be stayed in, or on [; centre; radius] */
  | 'bowl'
  /** nothing is below it [; point, unit normal] */
  | 'ground'
  /** to be stayed out of [; centre, half its size] */
  | 'box'
  /** from the arm a-b to the arm c-d [a, b, c, d], or from a direction to it [c, d; direction] */
  | 'angle'
  /** the circle in which a wheel meets others [centre, a point of it; ; radius] */
  | 'wheel'
  /** a filled polygon [its corners in order] */
  | 'area'
  /** [; point, normal] */
  | 'plane';

/** The constraint or force that a shape belongs to: its place among the scene's constraints or forces. */
export interface Source {
  list: 'constraint' | 'force';
  index: number;
}

/** What a shape with a tension (rod, rope, strut) has beside it. */
export interface Link {
  /** its place in `tension()`, in `Terms.tension` and among the numbers of `broken()` */
  place: number;
  /** the least its ends are apart, m; null for a rope */
  shortest: number | null;
  /** the most its ends are apart, m; null for a strut that lets them go; of a rod both are its length */
  longest: number | null;
  /** which multipliers are its own; of two limits the longest comes first */
  rows: number[];
}

/** One thing to draw: links, nails, springs, surfaces, curves, wheels, … */
export interface Shape {
  kind: ShapeKind;
  of: Source;
  /** the name of its constraint; '' where it is of a force */
  name: string;
  particles: number[];
  /** m, three numbers each */
  points: Float64Array;
  /** m */
  size: number;
  /** its points and its size follow t; without, they stay as they are */
  driven: boolean;
  /** of rods, ropes and struts, in the order of `tension()`; null for all others */
  link: Link | null;
}

/** What a scene is made of: all that does not change while it runs. */
export interface Structure {
  name: string;
  description: string;
  dimension: 2 | 3;
  /** how long the scene is meant to run, s */
  duration: number;
  particle_names: string[];
  row_names: string[];
  /** kg */
  masses: Float64Array;
  fixed: boolean[];
  /** everything to draw; driven shapes as they are at the present time */
  shapes: Shape[];
}

/** Everything the page's controls set. */
export interface Controls {
  /** s */
  h: number;
  integrator: IntegratorName;
  /** of implicit and bdf2: Newton iterations a frame */
  frame_budget: number;
  /** of auto: row solves a frame before it goes over to bdf2 */
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
  /** T + V less all that came in since the start: constant for an exact integrator */
  balance: number;
}

/** Something that happened at a moment. */
export interface StepEvent {
  /** `impact`: it was hit; `closed`, `opened`: it acts, or does not, from now on; `broke`: for good */
  kind: 'impact' | 'closed' | 'opened' | 'slipped' | 'stuck' | 'broke';
  /** its name */
  constraint: string;
  /** s */
  time: number;
  /** of an impact: how fast it closed in, m/s */
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
  energy: Energy;
  /** who carried the state; with auto, whom it chose */
  integrator: IntegratorName;
  solver: SolverName;
  /** what opened, closed, slipped, stuck or broke, in its order */
  events: StepEvent[];
  /** why auto went over to bdf2; null where it did not */
  too_stiff: string | null;
  warnings: string[];
}

/** What it took to bring the start onto C = 0 and Ċ = 0. */
export interface Projection {
  /** m, the farthest a particle was moved; 0 if the start was consistent */
  moved: number;
  /** m/s */
  velocity_changed: number;
  residual_before: number;
  iterations: number;
}

/** Every symbol of one evaluation, in the order it is computed. */
export interface Terms {
  /** s */
  time: number;
  positions: Float64Array;
  velocities: Float64Array;
  inverse_masses: Float64Array;
  applied_forces: Float64Array;
  residual: Float64Array;
  residual_rate: Float64Array;
  /** m × N, row after row; null where the system is too large to show */
  jacobian: Float64Array | null;
  acceleration_bias: Float64Array;
  /** m × m, row after row, before ε; null where the system is too large to show */
  constraint_matrix: Float64Array | null;
  rhs_bias: Float64Array;
  rhs_forces: Float64Array;
  rhs_stiffness: Float64Array;
  rhs_damping: Float64Array;
  right_hand_side: Float64Array;
  multipliers: Float64Array;
  constraint_forces: Float64Array;
  accelerations: Float64Array;
  /** N, one per link, signed: + is pull, 0 while slack */
  tension: Float64Array;
  /** one per row: it takes no part (an open contact, what is broken) */
  is_open: boolean[];
  /** of A; null where A is singular and too large for the rank to be counted */
  rank: number | null;
  warnings: string[];
}
