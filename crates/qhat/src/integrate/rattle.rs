//! RATTLE with substeps of its own choosing: order 2, symmetric, symplectic at a constant substep.
//!
//! ```text
//! q̇½ = q̇ + ½h W Q(q, q̇)
//! q' = q + h q̇½ + W J(q)ᵀ μ,             μ such that C(q', t + h) = 0
//! q̇* = q̇½ + W J(q)ᵀ μ/h
//! q̇' = q̇* + ½h W Q(q', ·) + W J(q')ᵀ ν,   ν such that J(q') q̇' + C_t = 0
//! ```
//!
//! μ = ½h² λ(t + h/3) and ν = ½h λ(t + 2h/3) to second order. Both are solved with A = J W Jᵀ: μ by Newton's method with A(q)
//! kept over the iterations, ν in one solve with A(q'), whose factor then serves the next substep. One factorization a
//! substep. The difference of the two multipliers comes for free and estimates the error.
//!
//! Fails where A(q) cannot follow the motion: the substep is halved, and where no length of it does, as with masses 1e11 apart
//! in one chain, DOPRI5 carries the rest of the frame, whose λ needs only accelerations. Feedback is not used.
//! Source: Andersen, RATTLE, J. Comput. Phys. 52 (1983); Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.

use super::Workspace;
use super::adaptive::control;
use super::adaptive::{self, Attempt, Frame, Outcome, Stepper};
use super::projection::largest;
use super::{dopri5, pair};
use crate::constraint::Jacobian;
use crate::drift::{Drift, drift};
use crate::drift::{attainable, worst_row};
use crate::energy;
use crate::error::StepError;
use crate::multiplier::SolveFor;
use crate::point::Motion;
use crate::report::{StepReport, Warning};
use crate::settings::{Integrator, Settings};
use crate::state::State;
use crate::system::System;

/// Newton's method with a kept matrix converges linearly, faster the shorter the substep; where this many iterations do not
/// do, two halves cost less.
const MAX_ITERATIONS: usize = 16;

/// The difference of the multipliers estimates the local error up to a factor. With this one the default tolerance of 1e-4
/// left energy errors of 1e-6 to 1e-3 after 2 s of chains and 60 s of pendulums, and 2e-2 after 5 s of a whipping net.
const ERROR_SCALE: f64 = 8.0;

/// Arrays of one substep.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    /// J(q) at the start of the substep, while the rows move on to q'.
    J: Jacobian,
    mu: Vec<f64>,
    nu: Vec<f64>,
    delta: Vec<f64>,
    /// W Q at the start.
    WQ: Vec<f64>,
    /// C_t at the start.
    Ct: Vec<f64>,
    /// W J(q)ᵀ μ and W J(q')ᵀ ν.
    push: Vec<f64>,
    kick: Vec<f64>,
    rowsum: Vec<f64>,
    damping: Vec<f64>,
}

impl Scratch {
    pub(super) fn new(system: &System) -> Self {
        let (coordinates, m, n) = (system.coordinate_count(), system.row_count(), system.particle_count());
        Scratch {
            J: system.empty_rows().J,
            mu: vec![0.0; m],
            nu: vec![0.0; m],
            delta: vec![0.0; m],
            WQ: vec![0.0; coordinates],
            Ct: vec![0.0; m],
            push: vec![0.0; coordinates],
            kick: vec![0.0; coordinates],
            rowsum: vec![0.0; n],
            damping: vec![0.0; n],
        }
    }
}

/// The method on its way over one frame.
struct RattleStepper<'a, const D: usize> {
    system: &'a System,
    settings: &'a Settings,
    workspace: &'a mut Workspace,
    /// λ of the substep before, the first guess of the next.
    lambda: Vec<f64>,
}

/// Carries the state over one frame.
pub(super) fn frame<const D: usize>(
    system: &System,
    state: &mut State,
    settings: &Settings,
    length: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    adaptive::check_length(length)?;
    let (start, factorizations) = (state.t, workspace.equation.solver.factorizations);
    let mut frame = Frame::new(system, settings, state, length);
    let carry = state.carry.take();
    let lambda = adaptive::begin::<D>(system, state, carry, workspace);
    workspace.factored_at.clear();
    let mut run = RattleStepper::<D> { system, settings, workspace, lambda };
    let end = frame.run(&mut run, state);
    let RattleStepper { workspace, lambda, .. } = run;
    frame.report.factorizations = workspace.equation.solver.factorizations - factorizations;
    frame.report.integrator = Integrator::Rattle;
    match end {
        Ok(_) => {
            workspace.note_factored(state);
            Ok(frame.finish(state, Some((lambda, &workspace.equation))))
        }
        Err(StepError::NotSatisfied { .. }) => {
            let mut report = frame.finish(state, None);
            report.warn(Warning::HandedOver { time: state.t });
            state.carry = None;
            let rest = pair::frame::<D>(&dopri5::DOPRI5, system, state, settings, start + length - state.t, workspace)?;
            report.absorb(StepReport { integrator: Integrator::Dopri5, ..rest });
            // The two parts of the frame add up to it but for rounding.
            state.t = start + length;
            Ok(report)
        }
        Err(error) => Err(error),
    }
}

impl<const D: usize> Stepper for RattleStepper<'_, D> {
    fn estimate_order(&self) -> f64 {
        3.0
    }

    fn longest(&mut self, state: &State) -> f64 {
        let Workspace { equation, rattle: Scratch { rowsum, damping, .. }, .. } = &mut *self.workspace;
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        control::longest_substep(self.system, equation, &self.lambda, motion, rowsum, damping)
    }

    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome {
        let RattleStepper { system, settings, workspace, lambda } = self;
        let Some((error, iterations)) = substep::<D>(system, state, settings, h, end, lambda, workspace) else {
            return Outcome::NotMet;
        };
        let before = energy::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t });
        let after = energy::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: end });
        // μ/h is the impulse where the substep begins, ν where it ends.
        let Workspace { equation, rattle: Scratch { mu, nu, Ct, .. }, .. } = &**workspace;
        let drives = energy::drive_power(system, Ct, mu) / h + energy::drive_power(system, &equation.rows.Ct, nu);
        Outcome::Met(Attempt { h, error, iterations, dissipation: 0.5 * h * (before + after), drives })
    }

    fn keep(&mut self, state: &mut State, h: f64) -> Drift {
        for (multiplier, nu) in self.lambda.iter_mut().zip(&self.workspace.rattle.nu) {
            *multiplier = 2.0 / h * nu;
        }
        std::mem::swap(&mut state.q, &mut self.workspace.q);
        std::mem::swap(&mut state.qd, &mut self.workspace.qd);
        drift::<D>(self.system, &self.workspace.equation.rows, &self.workspace.equation.inactive, &state.q)
    }

    fn turn_back(&mut self, state: &State) {
        adaptive::return_to::<D>(self.system, state, &mut self.workspace.equation);
    }

    fn end(&mut self, _: &mut State) {}

    fn write_tried(&self, state: &mut State) {
        state.q.copy_from_slice(&self.workspace.q);
        state.qd.copy_from_slice(&self.workspace.qd);
    }
}

/// Tries one substep from `state` to the time `end` into the workspace: the error estimate relative to the extent of the system and the
/// number of Newton iterations, or `None` if the constraints were not met.
fn substep<const D: usize>(
    system: &System,
    state: &State,
    settings: &Settings,
    h: f64,
    end: f64,
    lambda: &[f64],
    workspace: &mut Workspace,
) -> Option<(f64, usize)> {
    let Workspace { equation, q, qd, rattle: scratch, .. } = workspace;
    let W = &system.inverse_mass;
    let matrix = &system.matrix;
    scratch.J.blocks.copy_from_slice(&equation.rows.J.blocks);
    scratch.WQ.copy_from_slice(&equation.WQ);
    scratch.Ct.copy_from_slice(&equation.rows.Ct);

    // q̇½, and q' from the multipliers of the last substep.
    for (mu, multiplier) in scratch.mu.iter_mut().zip(lambda) {
        *mu = 0.5 * h * h * multiplier;
    }
    for k in 0..q.len() {
        qd[k] = state.qd[k] + 0.5 * h * scratch.WQ[k];
        q[k] = state.q[k] + h * qd[k];
    }
    scratch.J.add_impulse::<D>(W, &scratch.mu, 1.0, q);

    // μ by Newton's method: always one iteration, then until C = 0.
    let mut last = f64::INFINITY;
    let mut iterations = 0;
    loop {
        equation.constrain(system, Motion::<D> { q, qd, t: end });
        let off = worst_row(system, &equation.rows.C).1;
        if iterations > 0 && off <= attainable(system, settings, largest(q)) {
            break;
        }
        // Convergence slower than this will not arrive in time.
        if iterations == MAX_ITERATIONS || off.is_infinite() || (iterations > 1 && off > 0.7 * last) {
            return None;
        }
        last = off;
        equation.solver.solve(matrix, &equation.rows.C, SolveFor::Correction, &mut scratch.delta);
        for (mu, delta) in scratch.mu.iter_mut().zip(&scratch.delta) {
            *mu -= delta;
        }
        scratch.J.add_impulse::<D>(W, &scratch.delta, -1.0, q);
        iterations += 1;
    }
    scratch.push.fill(0.0);
    scratch.J.add_impulse::<D>(W, &scratch.mu, 1.0, &mut scratch.push);
    for k in 0..qd.len() {
        qd[k] += scratch.push[k] / h;
    }

    // Forces at q' with the velocity they lead to, the second half of the constraint's push included: second order also
    // where they depend on it.
    equation.apply_forces(system, Motion::<D> { q, qd, t: end });
    for k in 0..qd.len() {
        scratch.kick[k] = qd[k] + 0.5 * h * equation.WQ[k] + scratch.push[k] / h;
    }
    equation.apply_forces(system, Motion::<D> { q, qd: &scratch.kick, t: end });
    for k in 0..qd.len() {
        qd[k] += 0.5 * h * equation.WQ[k];
    }

    // ν in one solve, with the factor at q'.
    equation.factor::<D>(system, 0.0);
    equation.rows.rates::<D>(qd, &mut scratch.delta);
    equation.solver.solve(matrix, &scratch.delta, SolveFor::Force, &mut scratch.nu);
    for nu in &mut scratch.nu {
        *nu = -*nu;
    }
    scratch.kick.fill(0.0);
    equation.rows.J.add_impulse::<D>(W, &scratch.nu, 1.0, &mut scratch.kick);
    for k in 0..qd.len() {
        qd[k] += scratch.kick[k];
    }
    equation.constrain(system, Motion::<D> { q, qd, t: end });

    // ½h² (q̈ of the velocity stage − q̈ of the position stage), particle by particle.
    let mut error = 0.0_f64;
    for k in 0..qd.len() {
        let forces = 0.5 * h * h * (equation.WQ[k] - scratch.WQ[k]);
        let part = (forces + h * scratch.kick[k] - scratch.push[k]).abs();
        // What is not a number stays, so that the step is not kept.
        error = if error.is_nan() || part <= error { error } else { part };
    }
    Some((ERROR_SCALE * error / system.extent, iterations))
}
