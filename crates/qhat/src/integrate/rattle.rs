//! RATTLE in substeps by an error estimate: order 2, symmetric, symplectic at a constant substep.
//!
//! ```text
//! q̇½ = q̇ + ½h W Q(q, q̇)
//! q' = q + h q̇½ + δq,                δq = W J(q)ᵀ μ,    μ such that C(q', t + h) = 0
//! q̇* = q̇½ + δq/h
//! q̇' = q̇* + ½h W Q(q', ·) + δq̇,      δq̇ = W J(q')ᵀ ν,   ν such that J(q') q̇' + C_t = 0
//! ```
//!
//! μ = ½h² λ(t + h/3) and ν = ½h λ(t + 2h/3) to second order. Both are solved with A = J W Jᵀ: μ by Newton's method
//! with A(q) kept over the iterations, ν in one solve with A(q'), whose factor then serves the next substep. That is
//! one factorization a substep. The difference of the two multipliers estimates the error at no cost.
//!
//! The method fails where A(q) cannot follow the motion; the substep is then halved. Where no length of it does, as
//! with masses 1e11 apart in one chain, DOPRI5 advances the rest of the frame: its λ needs only accelerations.
//! Feedback is not used.
//! Source: Andersen, RATTLE, J. Comput. Phys. 52 (1983); Hairer, Lubich, Wanner, Geometric Numerical Integration,
//! VII.1.4.

use super::Workspace;
use super::adaptive::control::RowSums;
use super::adaptive::{self, Attempt, Outcome, Refusal, Stepper, Substeps, dopri5, pair_frame};
use super::edges::Passage;
use super::frame::Frame;
use crate::constraint::Jacobian;
use crate::drift::{Drift, attainable, drift, worst_row};
use crate::energy;
use crate::error::StepError;
use crate::multiplier::Equation;
use crate::point::{Motion, largest};
use crate::report::{StepReport, Warning};
use crate::settings::Integrator;
use crate::state::State;
use crate::system::System;

/// Newton iterations of one substep. With a kept matrix the method converges linearly, faster the shorter the
/// substep; two halves of the substep cost less than more iterations.
const MAX_ITERATIONS: usize = 16;

/// Factor on the error estimate: the difference of the multipliers estimates the local error up to a factor. With
/// this one a tolerance of 1e-4 leaves energy errors of 4e-7 to 5e-4 after 2 s of chains and of a net
/// (`benches/results/workloads.csv`).
const ERROR_SCALE: f64 = 8.0;

/// Arrays of one substep.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    /// J(q) at the start of the substep, while the rows move on to q'.
    J: Jacobian,
    mu: Vec<f64>,
    nu: Vec<f64>,
    /// A Newton correction of μ, then J(q') q̇* + C_t.
    delta: Vec<f64>,
    /// W Q at the start.
    WQ: Vec<f64>,
    /// C_t at the start.
    Ct: Vec<f64>,
    /// δq = W J(q)ᵀ μ.
    delta_q: Vec<f64>,
    /// δq̇ = W J(q')ᵀ ν; before that, a guess of q̇'.
    delta_qd: Vec<f64>,
    row_sums: RowSums,
}

impl Scratch {
    pub(super) fn new(system: &System) -> Self {
        let (coordinates, m) = (system.coordinate_count(), system.all_row_count());
        Scratch {
            J: system.empty_rows().J,
            mu: vec![0.0; m],
            nu: vec![0.0; m],
            delta: vec![0.0; m],
            WQ: vec![0.0; coordinates],
            Ct: vec![0.0; m],
            delta_q: vec![0.0; coordinates],
            delta_qd: vec![0.0; coordinates],
            row_sums: RowSums::new(system),
        }
    }
}

/// RATTLE under way over one frame.
struct RattleStepper<'a, 'f, const D: usize> {
    frame: &'a mut Frame<'f>,
    /// λ of the substep before, the first guess of the next.
    lambda: Vec<f64>,
}

/// Advances the state by one frame.
pub(super) fn frame<const D: usize>(frame: &mut Frame<'_>, state: &mut State) -> Result<StepReport, StepError> {
    let (start, length, factorizations) = (state.t, frame.length, frame.factorizations());
    let carry = state.carry.take();
    let mut substeps = Substeps::new(frame, state).steadily(carry.as_ref());
    let lambda = adaptive::begin::<D>(frame, state, carry);
    frame.workspace.equation.solver.memory.forget();
    let mut stepper = RattleStepper::<D> { frame, lambda };
    let end = substeps.run(&mut stepper, state);
    let lambda = stepper.lambda;
    substeps.report.factorizations = frame.factorizations() - factorizations;
    substeps.report.integrator = Integrator::Rattle;
    match end {
        Ok(_) => {
            frame.workspace.note_factored(state);
            Ok(substeps.finish(frame, state, Some(lambda)))
        }
        Err(error) if error.is_unmet() => {
            let mut report = substeps.finish(frame, state, None);
            report.warn(Warning::HandedOver { time: state.t });
            state.carry = None;
            let rest = pair_frame::frame::<D>(&dopri5::DOPRI5, &mut frame.over(start + length - state.t), state)?;
            report.absorb(StepReport { integrator: Integrator::Dopri5, ..rest });
            // The two parts add up to the frame only up to rounding.
            state.t = start + length;
            Ok(report)
        }
        Err(error) => Err(substeps.fail(frame, error)),
    }
}

impl<const D: usize> Stepper for RattleStepper<'_, '_, D> {
    fn estimate_order(&self) -> f64 {
        3.0
    }

    fn longest(&mut self, state: &State) -> f64 {
        let Frame { system, ref mut workspace, .. } = *self.frame;
        let Workspace { equation, rattle: Scratch { row_sums, .. }, .. } = &mut **workspace;
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        row_sums.longest_substep(system, equation, &self.lambda, motion)
    }

    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome {
        let Some((error, iterations)) = self.substep(state, h, end) else {
            return Outcome::NotMet;
        };
        let Frame { system, workspace, .. } = &*self.frame;
        let from = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let to = Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: end };
        let (Equation { rows, inactive, .. }, before) = (&workspace.equation, &workspace.rattle.J.blocks);
        if (Passage { system, rows, inactive, before, from, to }).is_barred() {
            return Outcome::Refused(Refusal::Edge);
        }
        let (before, after) = (energy::dissipation(system, from, &[]), energy::dissipation(system, to, &[]));
        // μ/h is the impulse where the substep begins, ν where it ends.
        let Workspace { equation, rattle: Scratch { mu, nu, Ct, .. }, .. } = &**workspace;
        let drives = energy::drive_power(system, Ct, mu) / h + energy::drive_power(system, &equation.rows.Ct, nu);
        Outcome::Met(Attempt { h, error, iterations, dissipation: 0.5 * h * (before + after), drives })
    }

    fn keep(&mut self, state: &mut State, h: f64) -> Drift {
        for (multiplier, nu) in self.lambda.iter_mut().zip(&self.frame.workspace.rattle.nu) {
            *multiplier = 2.0 / h * nu;
        }
        let Frame { system, workspace, .. } = &mut *self.frame;
        std::mem::swap(&mut state.q, &mut workspace.q);
        std::mem::swap(&mut state.qd, &mut workspace.qd);
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t + h };
        workspace.equation.follow_feet(system, motion, &mut state.feet);
        drift::<D>(system, &workspace.equation.rows, &workspace.equation.inactive, &state.q)
    }

    fn turn_back(&mut self, state: &State) {
        adaptive::return_to::<D>(self.frame.system, state, &mut self.frame.workspace.equation);
    }

    fn end(&mut self, _: &mut State) {}

    fn write_tried(&self, state: &mut State) {
        state.q.copy_from_slice(&self.frame.workspace.q);
        state.qd.copy_from_slice(&self.frame.workspace.qd);
    }
}

impl<const D: usize> RattleStepper<'_, '_, D> {
    /// Tries one substep from `state` to the time `end`, into the workspace. Returns the error estimate relative to
    /// the extent of the system and the number of Newton iterations; `None` if the constraints were not met.
    fn substep(&mut self, state: &State, h: f64, end: f64) -> Option<(f64, usize)> {
        let Frame { system, settings, ref mut workspace, .. } = *self.frame;
        let Workspace { equation, q, qd, rattle: scratch, .. } = &mut **workspace;
        let (W, matrix) = (&system.inverse_mass, &system.matrix);
        scratch.J.blocks.copy_from_slice(&equation.rows.J.blocks);
        scratch.WQ.copy_from_slice(&equation.WQ);
        scratch.Ct.copy_from_slice(&equation.rows.Ct);

        // q̇½, and q' with the multipliers of the last substep.
        for (mu, multiplier) in scratch.mu.iter_mut().zip(&self.lambda) {
            *mu = 0.5 * h * h * multiplier;
        }
        for k in 0..q.len() {
            qd[k] = state.qd[k] + 0.5 * h * scratch.WQ[k];
            q[k] = state.q[k] + h * qd[k];
        }
        scratch.J.add_impulse::<D>(W, &scratch.mu, 1.0, q);

        // μ by Newton's method: one iteration in any case, then until C = 0.
        let mut last = f64::INFINITY;
        let mut iterations = 0;
        loop {
            equation.constrain(system, Motion::<D> { q, qd, t: end });
            let off = worst_row(system, &equation.rows.C).1;
            if iterations > 0 && off <= attainable(system, settings, largest(q)) {
                break;
            }
            // A slower convergence than this does not arrive within the iterations.
            if iterations == MAX_ITERATIONS || off.is_infinite() || (iterations > 1 && off > 0.7 * last) {
                return None;
            }
            last = off;
            equation.solver.solve(matrix, &equation.rows.C, &mut scratch.delta);
            for (mu, delta) in scratch.mu.iter_mut().zip(&scratch.delta) {
                *mu -= delta;
            }
            scratch.J.add_impulse::<D>(W, &scratch.delta, -1.0, q);
            iterations += 1;
        }

        // q̇* = q̇½ + δq/h.
        scratch.delta_q.fill(0.0);
        scratch.J.add_impulse::<D>(W, &scratch.mu, 1.0, &mut scratch.delta_q);
        for k in 0..qd.len() {
            qd[k] += scratch.delta_q[k] / h;
        }

        // Forces at q' with a guess of q̇', the second half of the constraint's impulse included: this keeps second
        // order for forces that depend on the velocity.
        equation.apply_forces(system, Motion::<D> { q, qd, t: end });
        for k in 0..qd.len() {
            scratch.delta_qd[k] = qd[k] + 0.5 * h * equation.WQ[k] + scratch.delta_q[k] / h;
        }
        equation.apply_forces(system, Motion::<D> { q, qd: &scratch.delta_qd, t: end });
        for k in 0..qd.len() {
            qd[k] += 0.5 * h * equation.WQ[k];
        }

        // ν in one solve, with the factor of A(q'), and q̇' = … + δq̇.
        equation.factor::<D>(system, 0.0);
        equation.rows.rates::<D>(qd, &mut scratch.delta);
        equation.solver.solve(matrix, &scratch.delta, &mut scratch.nu);
        for nu in &mut scratch.nu {
            *nu = -*nu;
        }
        scratch.delta_qd.fill(0.0);
        equation.rows.J.add_impulse::<D>(W, &scratch.nu, 1.0, &mut scratch.delta_qd);
        for k in 0..qd.len() {
            qd[k] += scratch.delta_qd[k];
        }
        equation.constrain(system, Motion::<D> { q, qd, t: end });

        // The error: ½h² (q̈ of the velocity stage − q̈ of the position stage), the largest coordinate.
        let mut error = 0.0_f64;
        for k in 0..qd.len() {
            let forces = 0.5 * h * h * (equation.WQ[k] - scratch.WQ[k]);
            let part = (forces + h * scratch.delta_qd[k] - scratch.delta_q[k]).abs();
            // An error that is not a number stays, so that the substep is not kept.
            error = if error.is_nan() || part <= error { error } else { part };
        }
        Some((ERROR_SCALE * error / system.extent, iterations))
    }
}
