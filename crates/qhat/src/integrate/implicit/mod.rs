//! Methods that solve at the end of the step, with geometric stiffness in the matrix: what a stiff or heavily loaded system
//! needs where the step is given.
//!
//! A chain under tension T has transverse waves up to ω = 2√(T/(m L)), and every explicit method bounds h ω. Here
//! K = −Σ λ ∂²C/∂q² stands beside the mass, so that h ω may be anything. In tension it stiffens and M + h² K is positive
//! definite. In compression its sign is kept while the matrix allows: what is about to buckle must be seen to.
//!
//! Source: Tournier, Nesme, Gilles, Faure, Stable Constrained Dynamics, ACM Trans. Graph. 34 (2015).

pub(crate) mod backward_euler;
pub(crate) mod bdf2;
mod graph;
mod matrix;
mod newton;
#[cfg(test)]
mod tests;

pub(crate) use newton::Base;

use super::{Workspace, check_finite};
use crate::drift::drift;
use crate::energy;
use crate::error::StepError;
use crate::point::Motion;
use crate::report::{Solver, StepReport, Warning};
use crate::settings::{Feedback, Settings};
use crate::state::{Carry, Previous, State};
use crate::system::System;
use newton::{Ending, Newton, Tried};

/// Newton's method from q + h q̇ takes three to five iterations, in the whip crack of a chain ten, on a hanging net
/// forty-five; beyond this two halves of the step are cheaper.
const MOST_ITERATIONS: usize = 60;

/// After this many a step of a method of second order is done again with backward Euler. It is never cut short: an
/// unfinished step of BDF2 goes on into the next two.
const BEFORE_FALLBACK: usize = 10;

/// A frame is cut into no more than this many steps, a power of two: where such a short one does not help, none will.
const PARTS: u32 = 4096;

/// A method: how it writes q*, q̇* and h_e for a step of h.
pub(crate) struct Formula {
    /// From the state alone: backward Euler.
    pub(crate) first: fn(&State, f64, &mut Base),
    /// From the state and the one before, for a method of second order.
    pub(crate) second: Option<fn(&State, &Previous, f64, &mut Base)>,
}

/// Arrays of these methods, made when one of them first steps.
#[derive(Clone, Debug)]
pub(crate) struct Scratch {
    newton: Newton,
    base: Base,
}

impl Scratch {
    fn new(system: &System) -> Self {
        let zeros = || vec![0.0; system.coordinate_count()];
        Scratch { newton: Newton::new(system), base: Base { q: zeros(), qd: zeros(), h_e: 0.0, end: 0.0 } }
    }
}

/// Carries the state over one frame: one step, or halves of it where Newton's method does not arrive.
pub(crate) fn frame<const D: usize>(
    formula: &Formula,
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    let mut scratch = workspace.implicit.take().unwrap_or_else(|| Box::new(Scratch::new(system)));
    let before = workspace.equation.solver.factorizations;
    if state.carry.as_ref().is_none_or(|carry| carry.lambda.len() != system.row_count()) {
        // λ of the equation is the best first guess.
        let equation = workspace.solve::<D>(system, state, &Feedback::NONE);
        let (lambda, deficient) = (equation.lambda.clone(), equation.solver.deficient);
        let drives = energy::drive_power(system, &equation.rows.Ct, &lambda);
        state.carry = Some(Carry { lambda, substep: frame, deficient, previous: None, drives, resting: 0 });
    }
    workspace.factored_at.clear();
    scratch.newton.matrix.factorizations = workspace.equation.solver.factorizations - before;
    let outcome = substeps::<D>(formula, system, state, settings, frame, workspace, &mut scratch);
    workspace.implicit = Some(scratch);
    outcome
}

fn substeps<const D: usize>(
    formula: &Formula,
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
    scratch: &mut Scratch,
) -> Result<StepReport, StepError> {
    let mut report = StepReport { smallest_substep: frame, solver: Solver::EndOfStep, ..StepReport::default() };
    let start = state.t;
    // In parts of the frame, which add up without rounding.
    let (mut done, mut parts) = (0, PARTS);
    while done < PARTS {
        let h = frame * (f64::from(parts) / f64::from(PARTS));
        scratch.base.end = start + frame * (f64::from(done + parts) / f64::from(PARTS));
        let left = settings.frame_budget - report.iterations.min(settings.frame_budget);
        let ending = attempt::<D>(formula, system, state, settings, h, left, workspace, scratch);
        report.iterations += ending.iterations;
        if !ending.has_arrived && report.iterations < settings.frame_budget {
            report.rejected += 1;
            parts /= 2;
            if parts == 0 {
                state.carry = None;
                return Err(failure(system, state, workspace, &ending));
            }
            continue;
        }
        if !ending.has_arrived {
            report.warn(Warning::BudgetSpent {
                time: state.t + h,
                iterations: report.iterations,
                row: system.row_names.get(ending.miss.row).cloned().unwrap_or_default(),
                relative: ending.miss.relative,
            });
        }
        let Workspace { equation, q, qd, .. } = &mut *workspace;
        let mut tried = Tried { equation, q, qd };
        let kick = scratch.newton.project_velocities::<D>(system, &scratch.base, ending.is_factored, &mut tried);
        check_finite::<D>(system, state.t, &workspace.q, &workspace.qd)?;
        keep::<D>(formula, system, state, h, kick, workspace, scratch);
        report.substeps += 1;
        report.smallest_substep = report.smallest_substep.min(h);
        done += parts;
        state.t = scratch.base.end;
        let drift = drift::<D>(system, &workspace.equation.rows, &workspace.equation.inactive, &state.q);
        report.max_residual = report.max_residual.max(drift.residual);
        report.max_residual_rate = report.max_residual_rate.max(drift.residual_rate);
        report.max_relative_length_error = report.max_relative_length_error.max(drift.relative_length);
    }
    report.factorizations = scratch.newton.matrix.factorizations;
    report.energy = energy::energy(system, state);
    Ok(report)
}

/// One step of h into the workspace, with no more than `left` iterations: of second order where there is a history, else, or
/// where that is hard, of backward Euler.
#[expect(clippy::too_many_arguments, reason = "one step knows the whole of the frame")]
fn attempt<const D: usize>(
    formula: &Formula,
    system: &System,
    state: &State,
    settings: &Settings,
    h: f64,
    left: usize,
    workspace: &mut Workspace,
    scratch: &mut Scratch,
) -> Ending {
    let previous = state.carry.as_ref().and_then(|carry| carry.previous.as_ref());
    let mut spent = 0;
    if let (Some(second), Some(previous)) = (formula.second, previous) {
        second(state, previous, h, &mut scratch.base);
        // Half of what is left, so that backward Euler still has its turn.
        let ending = solve::<D>(system, state, settings, h, BEFORE_FALLBACK.min(left / 2), workspace, scratch);
        if ending.has_arrived {
            return ending;
        }
        spent = ending.iterations;
    }
    (formula.first)(state, h, &mut scratch.base);
    // A step takes an iteration even where the budget has none left: without it the rods would not be held at all.
    let limit = MOST_ITERATIONS.min(left.saturating_sub(spent)).max(1);
    let ending = solve::<D>(system, state, settings, h, limit, workspace, scratch);
    Ending { iterations: spent + ending.iterations, ..ending }
}

/// Newton's method from q + h q̇ with the last λ.
fn solve<const D: usize>(
    system: &System,
    state: &State,
    settings: &Settings,
    h: f64,
    limit: usize,
    workspace: &mut Workspace,
    scratch: &mut Scratch,
) -> Ending {
    let Workspace { equation, q, qd, .. } = workspace;
    let Scratch { newton, base } = scratch;
    for k in 0..q.len() {
        q[k] = state.q[k] + h * state.qd[k];
    }
    let scale = base.h_e * base.h_e;
    let lambda = state.carry.as_ref().map(|carry| carry.lambda.as_slice()).unwrap_or_default();
    for (mu, multiplier) in newton.mu.iter_mut().zip(lambda) {
        *mu = scale * multiplier;
    }
    newton.solve::<D>(system, settings, base, limit, &mut Tried { equation, q, qd })
}

/// Makes the step in the workspace the state, and what a restart needs its carry. `kick` is the work of the drives in the
/// projection of velocities [J].
fn keep<const D: usize>(
    formula: &Formula,
    system: &System,
    state: &mut State,
    h: f64,
    kick: f64,
    workspace: &mut Workspace,
    scratch: &Scratch,
) {
    let after = energy::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: scratch.base.end });
    let before = energy::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t });
    // The end point's rule is backward Euler's own; the trapezoidal rule is of second order.
    let mean = |before: f64, after: f64| if formula.second.is_some() { 0.5 * (before + after) } else { after };
    state.work.dissipation += h * mean(before, after);
    std::mem::swap(&mut state.q, &mut workspace.q);
    std::mem::swap(&mut state.qd, &mut workspace.qd);
    if let Some(carry) = &mut state.carry {
        let scale = scratch.base.h_e * scratch.base.h_e;
        for (multiplier, mu) in carry.lambda.iter_mut().zip(&scratch.newton.mu) {
            *multiplier = mu / scale;
        }
        // λ brings q onto C = 0, and the projection adds what the velocity needs: only both together are the force.
        let power = energy::drive_power(system, &workspace.equation.rows.Ct, &carry.lambda);
        let drives = power + kick / scratch.base.h_e;
        state.work.drives += h * mean(carry.drives, drives);
        carry.drives = drives;
        carry.substep = h;
        let previous = carry.previous.get_or_insert_with(|| Previous { q: Vec::new(), qd: Vec::new(), h });
        previous.q.clone_from(&workspace.q);
        previous.qd.clone_from(&workspace.qd);
        previous.h = h;
    }
}

fn failure(system: &System, state: &State, workspace: &Workspace, ending: &Ending) -> StepError {
    let row = ending.miss.row;
    match workspace.equation.rows.C.get(row) {
        Some(&residual) => StepError::NotSatisfied { time: state.t, row: system.row_names[row].clone(), residual },
        None => {
            StepError::NotFinite { time: state.t, particle: system.particle_names.first().cloned().unwrap_or_default() }
        }
    }
}
