//! RATTLE with substeps of its own choosing: order 2, symmetric, symplectic at a constant substep.
//!
//! ```text
//! q̇½ = q̇ + ½h W Q(q, q̇)
//! q' = q + h q̇½ + W J(q)ᵀ μ,             μ such that C(q') = 0
//! q̇* = q̇½ + W J(q)ᵀ μ/h
//! q̇' = q̇* + ½h W Q(q', ·) + W J(q')ᵀ ν,   ν such that J(q') q̇' = 0
//! ```
//!
//! μ = ½h² λ(t + h/3) and ν = ½h λ(t + 2h/3) to second order. Both are solved with A = J W Jᵀ: μ by Newton's method with A(q)
//! kept over the iterations, ν in one solve with A(q'), whose factor then serves the next substep. One factorization a
//! substep. The difference of the two multipliers comes for free and estimates the error.
//!
//! Fails where A(q) cannot follow the motion: the substep is halved, in the end with an error. Feedback is not used.
//! Source: Andersen, RATTLE, J. Comput. Phys. 52 (1983); Hairer, Lubich, Wanner, Geometric Numerical Integration, VII.1.4.

use super::control;
use super::projection::{add_impulse, attainable, worst_row};
use super::{Workspace, check_finite};
use crate::constraint::Jacobian;
use crate::error::StepError;
use crate::measure;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::report::StepReport;
use crate::settings::{Feedback, Settings};
use crate::state::{Carry, State};
use crate::system::System;

/// Newton's method with a kept matrix converges linearly, faster the shorter the substep; where this many iterations do not
/// do, two halves cost less.
const MAX_ITERATIONS: usize = 16;

/// A substep this much shorter than the frame means that shortening it does not help.
const SHORTEST: f64 = 1e-12;

/// The difference of the multipliers estimates the local error up to a factor. With this one the default tolerance of 1e-4
/// left energy errors of 1e-5 to 1e-3 after 2 s of chains, 60 s of pendulums and 5 s of nets.
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
            push: vec![0.0; coordinates],
            kick: vec![0.0; coordinates],
            rowsum: vec![0.0; n],
            damping: vec![0.0; n],
        }
    }
}

/// What one substep that succeeded says.
struct Substep {
    /// Error estimate relative to the extent of the system.
    error: f64,
    iterations: usize,
}

/// Carries the state over one frame.
pub(super) fn frame<const D: usize>(
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    let mut report = StepReport { smallest_substep: frame, ..StepReport::default() };
    let factorizations = workspace.equation.solver.factorizations;
    let Carry { mut lambda, substep: mut proposed, .. } = begin::<D>(system, state, frame, workspace);
    workspace.factored_at.clear();
    let start = state.t;
    let mut done = 0.0;
    while done < frame {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd };
        let Workspace { equation, rattle: scratch, .. } = workspace;
        let longest =
            control::longest_substep(system, equation, &lambda, motion, &mut scratch.rowsum, &mut scratch.damping);
        let h = fit(proposed.min(longest), frame - done);
        let outcome = substep::<D>(system, state, settings, h, &lambda, workspace);
        let accepted = outcome.filter(|substep| substep.error <= 2.0 * settings.tolerance || substep.error.is_nan());
        let Some(substep) = accepted else {
            report.rejected += 1;
            proposed = 0.5 * h;
            if proposed < SHORTEST * frame {
                state.carry = None;
                return Err(failure(system, state, workspace));
            }
            return_to::<D>(system, state, &mut workspace.equation);
            continue;
        };
        check_finite::<D>(system, state.t, &workspace.q, &workspace.qd)?;
        proposed = h * control::growth(substep.error, settings.tolerance);
        accept::<D>(system, state, h, workspace);
        let Workspace { equation, rattle: scratch, .. } = workspace;
        for (multiplier, nu) in lambda.iter_mut().zip(&scratch.nu) {
            *multiplier = 2.0 / h * nu;
        }
        done = if h == frame - done { frame } else { done + h };
        state.t = start + done;
        report.substeps += 1;
        report.iterations += substep.iterations;
        report.smallest_substep = report.smallest_substep.min(h);
        let drift = measure::drift(system, &equation.rows, Motion::<D> { q: &state.q, qd: &state.qd });
        report.max_residual = report.max_residual.max(drift.residual);
        report.max_residual_rate = report.max_residual_rate.max(drift.residual_rate);
        report.max_relative_length_error = report.max_relative_length_error.max(drift.relative_length);
        if report.substeps >= settings.max_substeps && done < frame {
            state.carry = None;
            return Err(StepError::TooManySubsteps { time: state.t, max_substeps: settings.max_substeps });
        }
    }
    for warning in workspace.equation.warnings(system) {
        report.warn(warning);
    }
    let deficient = workspace.equation.solver.deficient;
    state.carry = Some(Carry { lambda, substep: proposed, deficient });
    workspace.factored_at.clone_from(&state.q);
    report.factorizations = workspace.equation.solver.factorizations - factorizations;
    report.energy = measure::energy(system, state);
    Ok(report)
}

/// What the last frame carried over, or for a first frame λ from the equation itself. Leaves rows, forces and the factor
/// of A at the state; a factor that is there already is kept.
fn begin<const D: usize>(system: &System, state: &mut State, frame: f64, workspace: &mut Workspace) -> Carry {
    match state.carry.take() {
        Some(carry) => {
            let is_factored = workspace.factored_at == state.q;
            let equation = &mut workspace.equation;
            // Looking at terms between frames, or starting from a saved state, must not change a bit of what follows.
            if is_factored && equation.solver.deficient == carry.deficient {
                let motion = Motion::<D> { q: &state.q, qd: &state.qd };
                equation.apply_forces(system, motion);
                equation.constrain(system, motion);
            } else {
                return_to::<D>(system, state, equation);
                if carry.deficient {
                    equation.solver.regularize(&system.matrix.pattern);
                }
            }
            carry
        }
        None => {
            let equation = workspace.solve::<D>(system, state, &Feedback::NONE);
            Carry { lambda: equation.lambda.clone(), substep: frame, deficient: equation.solver.deficient }
        }
    }
}

/// Rows, forces and the factor of A at the state, wherever they are now.
fn return_to<const D: usize>(system: &System, state: &State, equation: &mut Equation) {
    let motion = Motion::<D> { q: &state.q, qd: &state.qd };
    equation.apply_forces(system, motion);
    equation.constrain(system, motion);
    equation.factor::<D>(system, 0.0);
}

/// The whole of what remains, half of it, or h: so that no sliver is left for the end.
fn fit(h: f64, remaining: f64) -> f64 {
    if h >= remaining {
        remaining
    } else if 2.0 * h > remaining {
        0.5 * remaining
    } else {
        h
    }
}

/// Tries one substep from `state` into the workspace; `None` if the constraints were not met.
fn substep<const D: usize>(
    system: &System,
    state: &State,
    settings: &Settings,
    h: f64,
    lambda: &[f64],
    workspace: &mut Workspace,
) -> Option<Substep> {
    let Workspace { equation, q, qd, rattle: scratch, .. } = workspace;
    let W = &system.inverse_mass;
    let pattern = &system.matrix.pattern;
    scratch.J.blocks.copy_from_slice(&equation.rows.J.blocks);
    scratch.WQ.copy_from_slice(&equation.WQ);

    // q̇½, and q' from the multipliers of the last substep.
    for (mu, multiplier) in scratch.mu.iter_mut().zip(lambda) {
        *mu = 0.5 * h * h * multiplier;
    }
    for k in 0..q.len() {
        qd[k] = state.qd[k] + 0.5 * h * scratch.WQ[k];
        q[k] = state.q[k] + h * qd[k];
    }
    add_impulse::<D>(&scratch.J, W, &scratch.mu, 1.0, q);

    // μ by Newton's method: always one iteration, then until C = 0.
    let mut last = f64::INFINITY;
    let mut iterations = 0;
    loop {
        equation.constrain(system, Motion::<D> { q, qd });
        let off = worst_row(system, &equation.rows.C).1;
        if iterations > 0 && off <= attainable(system, settings, q) {
            break;
        }
        // Convergence slower than this will not arrive in time.
        if iterations == MAX_ITERATIONS || off.is_infinite() || (iterations > 1 && off > 0.7 * last) {
            return None;
        }
        last = off;
        equation.solver.solve(pattern, &equation.rows.C, &mut scratch.delta);
        for (mu, delta) in scratch.mu.iter_mut().zip(&scratch.delta) {
            *mu -= delta;
        }
        add_impulse::<D>(&scratch.J, W, &scratch.delta, -1.0, q);
        iterations += 1;
    }
    scratch.push.fill(0.0);
    add_impulse::<D>(&scratch.J, W, &scratch.mu, 1.0, &mut scratch.push);
    for k in 0..qd.len() {
        qd[k] += scratch.push[k] / h;
    }

    // Forces at q' with the velocity they lead to, the second half of the constraint's push included: second order also
    // where they depend on it.
    equation.apply_forces(system, Motion::<D> { q, qd });
    for k in 0..qd.len() {
        scratch.kick[k] = qd[k] + 0.5 * h * equation.WQ[k] + scratch.push[k] / h;
    }
    equation.apply_forces(system, Motion::<D> { q, qd: &scratch.kick });
    for k in 0..qd.len() {
        qd[k] += 0.5 * h * equation.WQ[k];
    }

    // ν in one solve, with the factor at q'.
    equation.factor::<D>(system, 0.0);
    equation.rows.J.multiply::<D>(qd, &mut scratch.delta);
    equation.solver.solve(pattern, &scratch.delta, &mut scratch.nu);
    for nu in &mut scratch.nu {
        *nu = -*nu;
    }
    scratch.kick.fill(0.0);
    add_impulse::<D>(&equation.rows.J, W, &scratch.nu, 1.0, &mut scratch.kick);
    for k in 0..qd.len() {
        qd[k] += scratch.kick[k];
    }
    equation.constrain(system, Motion::<D> { q, qd });

    // ½h² (q̈ of the velocity stage − q̈ of the position stage), particle by particle.
    let mut error = 0.0_f64;
    for k in 0..qd.len() {
        let forces = 0.5 * h * h * (equation.WQ[k] - scratch.WQ[k]);
        error = error.max((forces + h * scratch.kick[k] - scratch.push[k]).abs());
    }
    Some(Substep { error: ERROR_SCALE * error / system.extent, iterations })
}

/// Makes the tried state the state.
fn accept<const D: usize>(system: &System, state: &mut State, h: f64, workspace: &mut Workspace) {
    let before = measure::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd });
    let after = measure::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd });
    state.work.dissipation += 0.5 * h * (before + after);
    std::mem::swap(&mut state.q, &mut workspace.q);
    std::mem::swap(&mut state.qd, &mut workspace.qd);
}

fn failure(system: &System, state: &State, workspace: &Workspace) -> StepError {
    let C = &workspace.equation.rows.C;
    let (row, _) = worst_row(system, C);
    match C.get(row) {
        Some(&residual) => StepError::NotSatisfied { time: state.t, row: system.row_names[row].clone(), residual },
        None => {
            StepError::NotFinite { time: state.t, particle: system.particle_names.first().cloned().unwrap_or_default() }
        }
    }
}
