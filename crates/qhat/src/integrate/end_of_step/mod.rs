//! Methods that solve at the end of the step, with geometric stiffness in the matrix: what a stiff or heavily loaded system
//! needs where the step is given.
//!
//! A chain under tension T has transverse waves up to ω = 2√(T/(m L)), and every explicit method bounds h ω. Here
//! K = −Σ λ ∂²C/∂q² stands beside the mass, so that h ω may be anything. In tension it stiffens and M + h² K is positive
//! definite. In compression its sign is kept while the matrix allows: what is about to buckle must be seen to.
//!
//! Source: Tournier, Nesme, Gilles, Faure, Stable Constrained Dynamics, ACM Trans. Graph. 34 (2015).

mod graph;
mod matrix;
mod newton;

pub(super) use newton::Base;

use super::{Workspace, check_finite};
use crate::error::StepError;
use crate::measure;
use crate::point::Motion;
use crate::report::{StepReport, Warning};
use crate::settings::{Feedback, Settings};
use crate::state::{Carry, Previous, State};
use crate::system::System;
use newton::{Ending, Newton};

/// Newton's method from q + h q̇ takes three to five iterations, in the whip crack of a chain ten, on a hanging net
/// forty-five; beyond this two halves of the step are cheaper.
const MOST_ITERATIONS: usize = 60;

/// After this many a step of a method of second order is done again with backward Euler. It is never cut short: an
/// unfinished step of BDF2 goes on into the next two.
const BEFORE_FALLBACK: usize = 10;

/// Halvings of the frame before giving up.
const MOST_HALVINGS: u32 = 12;

/// A method of second order: writes q*, q̇* and h_e for a step of h, or says that it has no history to go by.
pub(super) type SecondOrder = fn(&State, &Previous, f64, &mut Base);

/// Arrays of these methods, made when one of them first steps.
#[derive(Clone, Debug)]
pub(super) struct Scratch {
    newton: Newton,
    base: Base,
}

impl Scratch {
    fn new(system: &System) -> Self {
        let zeros = || vec![0.0; system.coordinate_count()];
        Scratch { newton: Newton::new(system), base: Base { q: zeros(), qd: zeros(), h_e: 0.0 } }
    }
}

/// Carries the state over one frame: one step, or halves of it where Newton's method does not arrive.
pub(super) fn frame<const D: usize>(
    first: fn(&State, f64, &mut Base),
    second: Option<SecondOrder>,
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    let mut scratch = workspace.end_of_step.take().unwrap_or_else(|| Box::new(Scratch::new(system)));
    workspace.factored_at.clear();
    let before = workspace.equation.solver.factorizations;
    if state.carry.is_none() {
        // λ of the equation is the best first guess; what is singular there is so only for an instant.
        let lambda = workspace.solve::<D>(system, state, &Feedback::NONE).lambda.clone();
        state.carry = Some(Carry { lambda, substep: frame, deficient: false, previous: None });
        workspace.factored_at.clear();
    }
    scratch.newton.matrix.factorizations = workspace.equation.solver.factorizations - before;
    let outcome = substeps::<D>(first, second, system, state, settings, frame, workspace, &mut scratch);
    workspace.end_of_step = Some(scratch);
    outcome
}

#[expect(clippy::too_many_arguments, reason = "frame's, handed on with the scratch taken out of the workspace")]
fn substeps<const D: usize>(
    first: fn(&State, f64, &mut Base),
    second: Option<SecondOrder>,
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
    scratch: &mut Scratch,
) -> Result<StepReport, StepError> {
    let mut report = StepReport { smallest_substep: frame, ..StepReport::default() };
    let (start, mut done) = (state.t, 0.0);
    let (mut h, mut halvings) = (frame, 0);
    while done < frame {
        let remaining = settings.frame_budget.saturating_sub(report.iterations);
        let mut ending = None;
        if let (Some(second), Some(previous)) = (second, history(state)) {
            second(state, previous, h, &mut scratch.base);
            let limit = BEFORE_FALLBACK.min(remaining / 2);
            let tried = attempt::<D>(system, state, settings, h, limit, workspace, scratch);
            report.iterations += tried.iterations;
            ending = Some(tried).filter(|tried| tried.has_arrived);
        }
        let ending = match ending {
            Some(ending) => ending,
            None => {
                first(state, h, &mut scratch.base);
                let limit = MOST_ITERATIONS.min(settings.frame_budget.saturating_sub(report.iterations)).max(1);
                let tried = attempt::<D>(system, state, settings, h, limit, workspace, scratch);
                report.iterations += tried.iterations;
                tried
            }
        };
        if !ending.has_arrived {
            if report.iterations < settings.frame_budget {
                report.rejected += 1;
                halvings += 1;
                h *= 0.5;
                if halvings > MOST_HALVINGS {
                    state.carry = None;
                    let residual = workspace.equation.rows.C.get(ending.miss.row).copied().unwrap_or(f64::NAN);
                    let row = system.row_names.get(ending.miss.row).cloned().unwrap_or_default();
                    return Err(StepError::NotSatisfied { time: state.t, row, residual });
                }
                continue;
            }
            report.warn(Warning::BudgetSpent {
                iterations: report.iterations,
                row: system.row_names.get(ending.miss.row).cloned().unwrap_or_default(),
                relative: ending.miss.relative,
                time: state.t + h,
            });
        }
        let Workspace { equation, q, qd, .. } = &mut *workspace;
        scratch.newton.project_velocities::<D>(system, &scratch.base, ending.is_factored, equation, q, qd);
        check_finite::<D>(system, state.t, &workspace.q, &workspace.qd)?;
        keep::<D>(system, state, h, workspace, scratch);
        report.substeps += 1;
        report.smallest_substep = report.smallest_substep.min(h);
        // Halves of halves of a frame add up to it without rounding.
        done += h;
        state.t = if done == frame { start + frame } else { start + done };
        let motion = Motion::<D> { q: &state.q, qd: &state.qd };
        let drift = measure::drift(system, &workspace.equation.rows, motion);
        report.max_residual = report.max_residual.max(drift.residual);
        report.max_residual_rate = report.max_residual_rate.max(drift.residual_rate);
        report.max_relative_length_error = report.max_relative_length_error.max(drift.relative_length);
    }
    report.factorizations = scratch.newton.matrix.factorizations;
    report.energy = measure::energy(system, state);
    Ok(report)
}

fn history(state: &State) -> Option<&Previous> {
    state.carry.as_ref().and_then(|carry| carry.previous.as_ref())
}

/// One step from the state with the base that was set, into the workspace.
fn attempt<const D: usize>(
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
    newton.solve::<D>(system, settings, base, limit, equation, q, qd)
}

/// Makes the step in the workspace the state, and what a restart needs its carry.
fn keep<const D: usize>(system: &System, state: &mut State, h: f64, workspace: &mut Workspace, scratch: &Scratch) {
    let power = measure::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd });
    state.work.dissipation += h * power;
    std::mem::swap(&mut state.q, &mut workspace.q);
    std::mem::swap(&mut state.qd, &mut workspace.qd);
    if let Some(carry) = &mut state.carry {
        let scale = scratch.base.h_e * scratch.base.h_e;
        for (multiplier, mu) in carry.lambda.iter_mut().zip(&scratch.newton.mu) {
            *multiplier = mu / scale;
        }
        carry.substep = h;
        let previous = carry.previous.get_or_insert_with(|| Previous { q: Vec::new(), qd: Vec::new(), h });
        previous.q.clone_from(&workspace.q);
        previous.qd.clone_from(&workspace.qd);
        previous.h = h;
    }
}
