//! Explicit Runge–Kutta methods on the equation itself: λ is solved for at every stage.
//!
//! ```text
//! q_i = q + h Σ_{j<i} a_ij q̇_j,   q̇_i = q̇ + h Σ_{j<i} a_ij k_j,   k_i = q̈(q_i, q̇_i)
//! q'  = q + h Σ b_i q̇_i,          q̇'  = q̇ + h Σ b_i k_i
//! ```
//!
//! A pair adds weights e_i that estimate the local error, e = h Σ e_i (q̇_i, k_i), and is carried in substeps of its own
//! choosing with q' brought onto C = 0 and q̇' onto Ċ = 0 after each. That changes nothing of the order: q' misses C = 0 by
//! no more than the method's own error.

use super::adaptive::{Attempt, MISSED, Method};
use super::projection::{add_impulse, attainable, worst_row};
use super::{StepWork, Workspace};
use crate::measure;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::{Feedback, Settings};
use crate::state::State;
use crate::system::System;

/// Most stages of any method here.
const STAGES: usize = 12;

/// Newton's method with the factor of the last stage gains two to four digits an iteration on what is a small correction.
const MAX_ITERATIONS: usize = 8;

/// A speed that crosses less than this part of the system's extent in one substep counts as rest.
const AT_REST: f64 = 1e-3;

/// a (row i has i entries) and b of a method with S stages.
pub(super) struct Tableau<const S: usize> {
    pub(super) a: [&'static [f64]; S],
    pub(super) b: [f64; S],
}

/// A method with an error estimate.
pub(super) struct Pair<const S: usize> {
    pub(super) order: u32,
    pub(super) tableau: Tableau<S>,
    /// e.
    pub(super) estimate: [f64; S],
    /// A second, coarser estimate; together |e|²/√(|e|² + 0.01 |e_coarse|²).
    pub(super) coarse: Option<[f64; S]>,
}

/// The motion at a stage, and the slopes of all of them.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    q: Vec<f64>,
    qd: Vec<f64>,
    velocity: Vec<Vec<f64>>,
    slope: Vec<Vec<f64>>,
    rate: Vec<f64>,
    delta: Vec<f64>,
}

impl Stages {
    pub(super) fn new(coordinates: usize, rows: usize) -> Self {
        let arrays = || vec![vec![0.0; coordinates]; STAGES];
        Stages {
            q: vec![0.0; coordinates],
            qd: vec![0.0; coordinates],
            velocity: arrays(),
            slope: arrays(),
            rate: vec![0.0; rows],
            delta: vec![0.0; rows],
        }
    }
}

/// One step of length h from `state` into `workspace.q`, `workspace.qd`; `is_factored` says that the factor at the state is
/// at hand.
pub(super) fn advance<const D: usize, const S: usize>(
    tableau: &Tableau<S>,
    system: &System,
    state: &State,
    h: f64,
    feedback: &Feedback,
    is_factored: bool,
    workspace: &mut Workspace,
) -> StepWork {
    let Workspace { equation, q, qd, stages, .. } = workspace;
    let mut work = StepWork { dissipation: 0.0, stabilization: 0.0 };
    for i in 0..S {
        combine(&state.q, h, tableau.a[i], &stages.velocity, &mut stages.q);
        combine(&state.qd, h, tableau.a[i], &stages.slope, &mut stages.qd);
        let motion = Motion::<D> { q: &stages.q, qd: &stages.qd };
        equation.solve(system, motion, feedback, is_factored && i == 0);
        if tableau.b[i] != 0.0 {
            let power: f64 = equation.Q_hat.iter().zip(&stages.qd).map(|(force, velocity)| force * velocity).sum();
            work.dissipation += tableau.b[i] * h * measure::dissipation(system, motion);
            work.stabilization += tableau.b[i] * h * power;
        }
        stages.velocity[i].copy_from_slice(&stages.qd);
        stages.slope[i].copy_from_slice(&equation.qdd);
    }
    combine(&state.q, h, &tableau.b, &stages.velocity, q);
    combine(&state.qd, h, &tableau.b, &stages.slope, qd);
    work
}

/// out = y + h Σ a_j k_j.
fn combine(y: &[f64], h: f64, a: &[f64], k: &[Vec<f64>], out: &mut [f64]) {
    out.fill(0.0);
    for (weight, slope) in a.iter().zip(k) {
        if *weight != 0.0 {
            for (sum, slope) in out.iter_mut().zip(slope) {
                *sum += weight * slope;
            }
        }
    }
    for (sum, y) in out.iter_mut().zip(y) {
        *sum = y + h * *sum;
    }
}

impl<const D: usize, const S: usize> Method<D> for Pair<S> {
    fn estimate_order(&self) -> f64 {
        f64::from(self.order)
    }

    fn longest(&self, _: &System, _: &State, _: &[f64], _: &mut Workspace) -> f64 {
        f64::INFINITY
    }

    fn attempt(
        &self,
        system: &System,
        state: &State,
        settings: &Settings,
        h: f64,
        _: &[f64],
        workspace: &mut Workspace,
    ) -> Option<Attempt> {
        let work = advance::<D, S>(&self.tableau, system, state, h, &Feedback::NONE, true, workspace);
        let error = self.error(system, h, workspace);
        if error > MISSED * settings.tolerance {
            return Some(Attempt { error, iterations: 0, dissipation: 0.0 });
        }
        let Workspace { equation, q, qd, stages, .. } = workspace;
        let iterations = positions::<D>(system, settings, equation, q, qd, &mut stages.delta)?;
        equation.factor::<D>(system, 0.0);
        equation.rows.J.multiply::<D>(qd, &mut stages.rate);
        equation.solver.solve(&system.matrix, &stages.rate, &mut stages.delta);
        add_impulse::<D>(&equation.rows.J, &system.inverse_mass, &stages.delta, -1.0, qd);
        equation.constrain(system, Motion::<D> { q, qd });
        Some(Attempt { error, iterations, dissipation: work.dissipation })
    }

    fn multipliers(&self, _: f64, workspace: &Workspace, lambda: &mut [f64]) {
        lambda.copy_from_slice(&workspace.equation.lambda);
    }
}

impl<const S: usize> Pair<S> {
    /// The estimate, positions relative to the extent and velocities to the fastest, whichever is larger.
    fn error(&self, system: &System, h: f64, workspace: &Workspace) -> f64 {
        let Workspace { qd, stages, .. } = workspace;
        let fastest = qd.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        // What is at rest but for roundoff has no speed to compare with.
        let speed = fastest.max(AT_REST * system.extent / h);
        let mut largest = 0.0_f64;
        for (k, scale) in [(&stages.velocity, system.extent), (&stages.slope, speed)] {
            let (fine, coarse) = (norm(&self.estimate, k), self.coarse.map(|weights| norm(&weights, k)));
            let estimate = match coarse {
                Some(coarse) if fine > 0.0 => fine * fine / (fine * fine + 0.01 * coarse * coarse).sqrt(),
                _ => fine,
            };
            largest = largest.max(h * estimate / scale);
        }
        largest
    }
}

/// Root mean square of Σ e_i k_i.
fn norm(e: &[f64], k: &[Vec<f64>]) -> f64 {
    let coordinates = k[0].len();
    let mut sum = 0.0;
    for c in 0..coordinates {
        let mut combination = 0.0;
        for (weight, slope) in e.iter().zip(k) {
            combination += weight * slope[c];
        }
        sum += combination * combination;
    }
    (sum / coordinates.max(1) as f64).sqrt()
}

/// Brings q onto C = 0 with the factor of the last stage; the number of iterations, or `None` if it does not converge.
/// Leaves the rows at q.
fn positions<const D: usize>(
    system: &System,
    settings: &Settings,
    equation: &mut Equation,
    q: &mut [f64],
    qd: &[f64],
    delta: &mut [f64],
) -> Option<usize> {
    for iteration in 0..=MAX_ITERATIONS {
        equation.constrain(system, Motion::<D> { q, qd });
        let off = worst_row(system, &equation.rows.C).1;
        if off <= attainable(system, settings, q) {
            return Some(iteration);
        }
        if off.is_infinite() {
            return None;
        }
        equation.solver.solve(&system.matrix, &equation.rows.C, delta);
        add_impulse::<D>(&equation.rows.J, &system.inverse_mass, delta, -1.0, q);
    }
    None
}
