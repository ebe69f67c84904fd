// Each control: its name, its effect in one sentence, its unit and its range.

import type { Controls } from '../engine';
import type { Scale } from './scale';

export type NumberControl = 'gravity' | 'drag' | 'ks' | 'kd' | 'diagonal_drag' | 'elasticity' | 'h';

export interface ControlSpec {
  key: NumberControl;
  label: string;
  symbol: string;
  unit: string;
  sentence: string;
  scale: Scale;
  /** has an effect only under integrators that hold the constraints by feedback */
  feedback: boolean;
}

/** The two menus of the first program. */
export const MENUS: readonly ControlSpec[] = [
  {
    key: 'diagonal_drag',
    label: 'Diagonal drag',
    symbol: 'ε',
    unit: 'of A',
    sentence: 'Adds ε to the diagonal of A: λ exists even where A is singular, and the constraints soften.',
    scale: { kind: 'log', from: 1e-6, to: 100, zero: true },
    feedback: true,
  },
  {
    key: 'elasticity',
    label: 'Elasticity',
    symbol: 'e',
    unit: '',
    sentence: 'Scales the constraint force Q̂ by 1 − e: less rigid, slower to explode; 0 is off.',
    scale: { kind: 'linear', from: 0, to: 0.99, step: 0.01 },
    feedback: true,
  },
];

export const FORCES: readonly ControlSpec[] = [
  {
    key: 'gravity',
    label: 'Gravity',
    symbol: 'g',
    unit: 'm/s²',
    sentence: 'Pulls every particle down with the same acceleration.',
    scale: { kind: 'linear', from: 0, to: 30, step: 0.01 },
    feedback: false,
  },
  {
    key: 'drag',
    label: 'Drag',
    symbol: 'c',
    unit: 'N·s/m',
    sentence: 'Brakes every particle against its velocity, −c q̇, and so takes energy away.',
    scale: { kind: 'log', from: 1e-3, to: 100, zero: true },
    feedback: false,
  },
];

export const FEEDBACK: readonly ControlSpec[] = [
  {
    key: 'ks',
    label: 'Feedback stiffness',
    symbol: 'ks',
    unit: '1/s²',
    sentence: 'Pulls a violated constraint back like a spring: ks in C̈ + kd Ċ + ks C = 0.',
    scale: { kind: 'log', from: 0.1, to: 1e5, zero: true },
    feedback: true,
  },
  {
    key: 'kd',
    label: 'Feedback damping',
    symbol: 'kd',
    unit: '1/s',
    sentence: 'Damps the pull of ks; explicit Euler needs ks·h < kd.',
    scale: { kind: 'log', from: 0.1, to: 1e3, zero: true },
    feedback: true,
  },
];

export const STEP: ControlSpec = {
  key: 'h',
  label: 'Step',
  symbol: 'h',
  unit: 's',
  sentence: 'Time from one state to the next: smaller is more exact and costs more.',
  scale: { kind: 'log', from: 1e-4, to: 0.1, zero: false },
  feedback: false,
};

export const INTEGRATOR_SENTENCES: Record<Controls['integrator'], string> = {
  auto: 'dop853; radau5 where damping or stiffness bounds its substeps; bdf2 where neither finishes a frame in time.',
  euler:
    'The method of the first program: the force at the start acts over the whole step. It drifts and gains energy.',
  'symplectic-euler':
    'Velocities first, then positions with the new velocities: energy stays close, the constraints still drift.',
  rk4: 'Four force evaluations a step: small drift, never corrected without feedback.',
  rattle: 'Projects positions and velocities onto the constraints at every step: no drift to correct.',
  dopri5:
    'Order five with adaptive substeps, projected after each substep: accurate and cheap for small systems.',
  dop853:
    'Order eight with adaptive substeps, projected after each substep: the most accurate integrator here.',
  radau5:
    'Order five, solved at the end of adaptive substeps: for stiff springs and dampers, whose rates bound no substep.',
  implicit: 'Backward Euler: stable under any load at any h, and loses energy.',
  bdf2: 'Backward differences of order two: stable under any load at any h, and loses far less energy.',
};

export const FORMULATION_SENTENCES: Record<Controls['formulation'], string> = {
  mixed: 'This scene mixes both forms; a choice here changes all constraints.',
  modern: 'C = |d| − r and x − p: λ is a force in newtons, and the nail holds.',
  classic:
    'C = d·d − r² and |x − p|², as in the first program. The gradient of |x − p|² is zero where the nail holds.',
};

/** Gravity as one signed number along the direction in which the scene's own gravity pulls. */
function gravitySize(gravity: readonly number[], down: readonly number[]): number {
  // + 0 turns −0, which a weightless scene would show, into 0
  return gravity.reduce((sum, component, k) => sum + component * down[k], 0) + 0;
}

export function downOf(gravity: readonly number[], dimension: 2 | 3): number[] {
  const size = Math.hypot(...gravity);
  if (size > 0) return gravity.map((component) => component / size);
  return dimension === 2 ? [0, -1, 0] : [0, 0, -1];
}

export function readControl(controls: Controls, key: NumberControl, down: readonly number[]): number {
  return key === 'gravity' ? gravitySize(controls.gravity, down) : controls[key];
}

export function withControl(
  controls: Controls,
  key: NumberControl,
  value: number,
  down: readonly number[],
): Controls {
  if (key === 'gravity') return { ...controls, gravity: down.map((component) => component * value) };
  return { ...controls, [key]: value };
}
