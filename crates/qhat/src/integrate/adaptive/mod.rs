//! A frame in substeps of a method's own choosing: try, measure, keep or halve.

pub(crate) mod control;
pub(crate) mod dop853;
pub(crate) mod dopri5;
pub(crate) mod pair;

use super::{Workspace, check_finite};
use crate::drift::Drift;
use crate::drift::worst_row;
use crate::energy;
use crate::error::StepError;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::report::StepReport;
use crate::settings::SettingsError;
use crate::settings::{Feedback, Settings};
use crate::space::in_dimension;
use crate::state::{Carry, State};
use crate::system::System;

/// Refuses a frame that would never end, or end before it began.
///
/// # Errors
/// A length that is not finite and positive.
pub(crate) fn check_length(length: f64) -> Result<(), SettingsError> {
    if length.is_finite() && length > 0.0 {
        Ok(())
    } else {
        Err(SettingsError::OutOfRange { name: "frame", value: length, range: "finite and positive" })
    }
}

/// A substep this much shorter than the frame means that shortening it does not help.
const SHORTEST: f64 = 1e-12;

/// How far the estimate may miss the tolerance before a substep is done again: the controller aims at the tolerance itself,
/// and a substep that is a little too long costs less than two.
pub(crate) const MISSED: f64 = 3.0;

/// One method on its way over one frame. It may keep the motion in arrays of its own between `begin` and `end`.
pub(crate) trait Stepper {
    /// The power of h with which the error estimate grows.
    fn estimate_order(&self) -> f64;

    /// The longest substep worth trying [s].
    fn longest(&mut self, state: &State) -> f64;

    /// Tries one substep of h, which brings t to `end`. What misses the tolerance need not be finished.
    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome;

    /// Goes on from what was tried last.
    fn keep(&mut self, state: &mut State, h: f64) -> Drift;

    /// Goes back to where it was tried from.
    fn turn_back(&mut self, state: &State);

    /// Writes the motion to the state.
    fn end(&mut self, state: &mut State);

    /// Writes what was tried last to a state: to name what went wrong in it.
    fn write_tried(&self, state: &mut State);
}

/// What became of one substep.
pub(crate) enum Outcome {
    /// The constraints are met.
    Met(Attempt),
    /// They are not.
    NotMet,
    /// The method cannot go on from here, because rows depend on each other.
    Singular,
    /// It cannot go on at all.
    Failed(StepError),
}

/// How far a frame has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// To its end.
    Whole,
    /// To where rows depend on each other.
    Singular,
    /// To where it had used its substeps, or showed that they would not do.
    OutOfWork,
}

/// What one substep that met the constraints says.
pub(crate) struct Attempt {
    /// What was met [s]: less than what was tried where an event ends it.
    pub(crate) h: f64,
    /// Error estimate over the tolerance's own unit: relative to the extent of the system.
    pub(crate) error: f64,
    /// Newton iterations on C(q) = 0.
    pub(crate) iterations: usize,
    /// Work of forces without a potential [J].
    pub(crate) dissipation: f64,
    /// Work of the drives [J].
    pub(crate) drives: f64,
}

/// One frame: how far it has come, and what there is to report.
pub(crate) struct Frame<'a> {
    pub(crate) system: &'a System,
    pub(crate) settings: &'a Settings,
    start: f64,
    length: f64,
    done: f64,
    /// Substeps that may be tried, those taken back included.
    limit: usize,
    tried: usize,
    /// The substep to try next [s].
    pub(crate) proposed: f64,
    pub(crate) report: StepReport,
}

impl<'a> Frame<'a> {
    /// A frame of a length [s] that begins at a state, with as many substeps as it takes.
    pub(crate) fn new(system: &'a System, settings: &'a Settings, state: &State, length: f64) -> Self {
        let report = StepReport { smallest_substep: length, ..StepReport::default() };
        let proposed = state.carry.as_ref().map_or(length, |carry| carry.substep);
        let (done, tried, limit) = (0.0, 0, usize::MAX);
        Frame { system, settings, start: state.t, length, done, limit, tried, proposed, report }
    }

    /// The same with no more than so many substeps, or as many as show that they will not do.
    pub(crate) fn within(self, limit: usize) -> Self {
        Frame { limit, ..self }
    }

    /// Goes on to the end of the frame, or as far as the method can. The state is up to date in any case, t included.
    pub(crate) fn run(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        let outcome = self.substeps(method, state);
        method.end(state);
        outcome
    }

    fn substeps(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        while self.done < self.length {
            if self.is_hopeless() {
                return Ok(End::OutOfWork);
            }
            self.tried += 1;
            let h = fit(self.proposed.min(method.longest(state)), self.length - self.done);
            let done = if h == self.length - self.done { self.length } else { self.done + h };
            let end = self.start + done;
            let attempt = match method.attempt(state, h, end) {
                Outcome::Singular => return Ok(End::Singular),
                Outcome::Failed(error) => return Err(error),
                Outcome::NotMet => None,
                Outcome::Met(attempt) if attempt.error.is_nan() => return Err(self.not_finite(method, state)),
                Outcome::Met(attempt) => Some(attempt),
            };
            let order = method.estimate_order();
            let growth = attempt.as_ref().map(|attempt| control::growth(attempt.error, self.settings.tolerance, order));
            let Some(attempt) = attempt.filter(|attempt| attempt.error <= MISSED * self.settings.tolerance) else {
                self.report.rejected += 1;
                self.proposed = h * growth.unwrap_or(0.5);
                if self.proposed < SHORTEST * self.length {
                    return Err(self.not_satisfied(method, state, end));
                }
                method.turn_back(state);
                continue;
            };
            self.proposed = h * growth.unwrap_or(1.0);
            let is_cut = attempt.h < h;
            let (h, done) = if is_cut { (attempt.h, self.done + attempt.h) } else { (h, done) };
            let end = self.start + done;
            let drift = method.keep(state, h);
            state.work.dissipation += attempt.dissipation;
            state.work.drives += attempt.drives;
            (self.done, state.t) = (done, end);
            let report = &mut self.report;
            report.substeps += 1;
            report.iterations += attempt.iterations;
            if h > 0.0 {
                report.smallest_substep = report.smallest_substep.min(h);
            }
            report.max_residual = report.max_residual.max(drift.residual);
            report.max_residual_rate = report.max_residual_rate.max(drift.residual_rate);
            report.max_relative_length_error = report.max_relative_length_error.max(drift.relative_length);
            let max_substeps = self.settings.max_substeps;
            // With a limit of its own the frame ends at that.
            if report.substeps >= max_substeps && self.done < self.length && self.limit == usize::MAX {
                return Err(StepError::TooManySubsteps { time: state.t, max_substeps });
            }
        }
        Ok(End::Whole)
    }

    /// Whether the substeps are used up, or an eighth of them has come less than a quarter as far as it should.
    fn is_hopeless(&self) -> bool {
        let part = self.tried as f64 / self.limit as f64;
        self.tried >= self.limit || (self.tried >= 16 && part > 0.125 && 4.0 * self.done < part * self.length)
    }

    /// Which particle of what was tried is lost: an error that is not a number is not for a shorter substep to mend.
    fn not_finite(&self, method: &impl Stepper, state: &State) -> StepError {
        let mut tried = state.clone();
        method.write_tried(&mut tried);
        let checked = in_dimension!(self.system.dimension, D => {
            check_finite::<D>(self.system, state.t, &tried.q, &tried.qd)
        });
        // Sums of finite numbers may overflow, too; then no particle is to blame more than another.
        let first = || self.system.particle_names.first().cloned().unwrap_or_default();
        checked.err().unwrap_or_else(|| StepError::NotFinite { time: state.t, particle: first() })
    }

    /// Which row of what was tried is farthest off.
    fn not_satisfied(&self, method: &impl Stepper, state: &State, end: f64) -> StepError {
        let mut tried = state.clone();
        method.write_tried(&mut tried);
        in_dimension!(self.system.dimension, D => {
            let mut rows = self.system.empty_rows();
            let constraints = self.system.constraints.iter().map(|named| &named.constraint);
            rows.evaluate(constraints, Motion::<D> { q: &tried.q, qd: &tried.qd, t: end });
            let (row, _) = worst_row(self.system, &rows.C);
            match rows.C.get(row) {
                Some(&residual) => {
                    StepError::NotSatisfied { time: state.t, row: self.system.row_names[row].clone(), residual }
                }
                None => self.not_finite(method, state),
            }
        })
    }

    /// What a frame leaves: the report, and in the state what the next one goes on from. `general` is λ and the equation, where
    /// the frame ended on the general path.
    pub(crate) fn finish(mut self, state: &mut State, general: Option<(Vec<f64>, &Equation)>) -> StepReport {
        let (lambda, drives, deficient) = match general {
            Some((lambda, equation)) => {
                for warning in equation.warnings(self.system) {
                    self.report.warn(warning);
                }
                let drives = energy::drive_power(self.system, &equation.rows.Ct, &lambda);
                (lambda, drives, equation.solver.deficient)
            }
            None => (Vec::new(), 0.0, false),
        };
        state.carry = Some(Carry { lambda, substep: self.proposed, deficient, previous: None, drives, resting: 0 });
        self.report.energy = energy::energy(self.system, state);
        self.report
    }
}

/// λ at the state, from the last frame or for a first one from the equation itself. Leaves rows, forces and the factor of A
/// at the state; a factor that is there already is kept.
pub(crate) fn begin<const D: usize>(
    system: &System,
    state: &State,
    carry: Option<Carry>,
    workspace: &mut Workspace,
) -> Vec<f64> {
    workspace.set_modes(system, state);
    let Some(carry) = carry.filter(|carry| carry.lambda.len() == system.row_count()) else {
        return workspace.solve::<D>(system, state, &Feedback::NONE).lambda.clone();
    };
    let is_factored = workspace.is_factored_at(state);
    let equation = &mut workspace.equation;
    // Looking at terms between frames, or starting from a saved state, must not change a bit of what follows.
    if is_factored && !equation.solver.deficient && !carry.deficient {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        equation.apply_forces(system, motion);
        equation.constrain(system, motion);
    } else {
        // What was singular in the last frame is asked anew.
        equation.solver.stays_deficient = false;
        return_to::<D>(system, state, equation);
    }
    carry.lambda
}

/// Rows, forces and the factor of A at the state, wherever they are now.
pub(crate) fn return_to<const D: usize>(system: &System, state: &State, equation: &mut Equation) {
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
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
