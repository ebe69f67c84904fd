//! A frame in substeps of a method's own choosing: try, measure, keep or halve.

use super::control;
use super::projection::worst_row;
use super::{Workspace, check_finite};
use crate::error::StepError;
use crate::measure;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::report::StepReport;
use crate::settings::{Feedback, Settings};
use crate::state::{Carry, State};
use crate::system::System;

/// A substep this much shorter than the frame means that shortening it does not help.
const SHORTEST: f64 = 1e-12;

/// How far the estimate may miss the tolerance before a substep is done again: the controller aims at the tolerance itself,
/// and a substep that is a little too long costs less than two.
pub(super) const MISSED: f64 = 2.0;

/// One method of one substep.
pub(super) trait Method<const D: usize> {
    /// The power of h with which the error estimate grows.
    fn estimate_order(&self) -> f64;

    /// The longest substep worth trying [s]. Rows and λ are those of the state.
    fn longest(&self, system: &System, state: &State, lambda: &[f64], workspace: &mut Workspace) -> f64;

    /// Tries one substep from `state` into the workspace, rows, forces and factor at the new state; `None` if the
    /// constraints were not met. `lambda` is what the last substep left, a first guess. What misses the tolerance need not be
    /// finished.
    fn attempt(
        &self,
        system: &System,
        state: &State,
        settings: &Settings,
        h: f64,
        lambda: &[f64],
        workspace: &mut Workspace,
    ) -> Option<Attempt>;

    /// λ to carry on from a substep that was kept.
    fn multipliers(&self, h: f64, workspace: &Workspace, lambda: &mut [f64]);
}

/// What one substep that met the constraints says.
pub(super) struct Attempt {
    /// Error estimate over the tolerance's own unit: relative to the extent of the system.
    pub(super) error: f64,
    /// Newton iterations on C(q) = 0.
    pub(super) iterations: usize,
    /// Work of forces without a potential [J].
    pub(super) dissipation: f64,
}

/// Carries the state over one frame.
pub(super) fn frame<const D: usize>(
    method: &impl Method<D>,
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
        let longest = method.longest(system, state, &lambda, workspace);
        let h = fit(proposed.min(longest), frame - done);
        let outcome = method.attempt(system, state, settings, h, &lambda, workspace);
        let order = method.estimate_order();
        let growth = outcome.as_ref().map(|attempt| control::growth(attempt.error, settings.tolerance, order));
        // An error that is not a number is not for a shorter substep to mend: it is reported below.
        let kept = outcome.filter(|attempt| attempt.error.is_nan() || attempt.error <= MISSED * settings.tolerance);
        let Some(attempt) = kept else {
            report.rejected += 1;
            proposed = h * growth.unwrap_or(0.5);
            if proposed < SHORTEST * frame {
                state.carry = None;
                return Err(failure(system, state, workspace));
            }
            return_to::<D>(system, state, &mut workspace.equation);
            continue;
        };
        check_finite::<D>(system, state.t, &workspace.q, &workspace.qd)?;
        proposed = h * growth.unwrap_or(1.0);
        method.multipliers(h, workspace, &mut lambda);
        std::mem::swap(&mut state.q, &mut workspace.q);
        std::mem::swap(&mut state.qd, &mut workspace.qd);
        state.work.dissipation += attempt.dissipation;
        done = if h == frame - done { frame } else { done + h };
        state.t = start + done;
        report.substeps += 1;
        report.iterations += attempt.iterations;
        report.smallest_substep = report.smallest_substep.min(h);
        let motion = Motion::<D> { q: &state.q, qd: &state.qd };
        let drift = measure::drift(system, &workspace.equation.rows, motion);
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
    state.carry = Some(Carry { lambda, substep: proposed, deficient, previous: None });
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
            Carry {
                lambda: equation.lambda.clone(),
                substep: frame,
                deficient: equation.solver.deficient,
                previous: None,
            }
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
