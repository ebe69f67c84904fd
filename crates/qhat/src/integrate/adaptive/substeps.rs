//! The frame loop: propose a substep, attempt it, judge it, reject it or accept and book it.

use super::{Attempt, Outcome, Stepper};
use crate::drift::{Drift, worst_row};
use crate::energy;
use crate::error::StepError;
use crate::integrate::check_finite;
use crate::integrate::frame::Frame;
use crate::integrate::watch::TensionWatch;
use crate::point::Motion;
use crate::report::StepReport;
use crate::settings::Settings;
use crate::space::in_dimension;
use crate::state::{Carry, State};
use crate::system::System;

/// Length of a substep, in frames, below which shortening it does not help.
const SHORTEST: f64 = 1e-12;

/// Error of an accepted substep, in tolerances. The controller aims at the tolerance itself, and a substep that is a
/// little too long costs less than two.
const MISSED: f64 = 3.0;

/// Part of the substep by which a substep that does not meet the constraints is tried again.
const HALF: f64 = 0.5;

/// Whether a substep with this error estimate is kept; an error that is not a number is not.
pub(crate) fn accepts(error: f64, settings: &Settings) -> bool {
    error <= MISSED * settings.tolerance
}

/// The place that a frame has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// To its end.
    Whole,
    /// To a state where A is singular on this path.
    Singular,
    /// To the limit of its substeps, or to where they showed that they would not do.
    OutOfWork,
}

/// A substep that is proposed: its length, t at its end [s], and how much of the frame is then done [s].
#[derive(Clone, Copy, Debug)]
struct Proposal {
    h: f64,
    end: f64,
    done: f64,
}

/// The judgement on an attempt; `growth` is the factor from this substep to the next.
enum Verdict {
    Accepted { attempt: Attempt, growth: f64 },
    Rejected { growth: f64 },
    Singular,
}

/// The substeps of one frame: how far they have come, and their report.
pub(crate) struct Substeps<'a> {
    system: &'a System,
    settings: &'a Settings,
    start: f64,
    length: f64,
    done: f64,
    /// Substeps that may be tried, rejected ones included.
    limit: usize,
    tried: usize,
    /// The substep to try next [s].
    proposed: f64,
    pub(crate) report: StepReport,
    /// The watch of the workspace, until `finish` or `fail` puts it back.
    watch: Option<TensionWatch>,
}

impl<'a> Substeps<'a> {
    /// For a frame that begins at a state, with as many substeps as it takes.
    pub(crate) fn new(frame: &mut Frame<'a>, state: &State) -> Self {
        let watch = frame.workspace.watch.take();
        let Frame { system, settings, length, .. } = *frame;
        let report = StepReport { smallest_substep: length, ..StepReport::default() };
        let proposed = state.carry.as_ref().map_or(length, |carry| carry.substep);
        let (done, tried, limit) = (0.0, 0, usize::MAX);
        Substeps { system, settings, start: state.t, length, done, limit, tried, proposed, report, watch }
    }

    /// The same with at most `limit` substeps, or as many as show that these will not do.
    pub(crate) fn within(self, limit: usize) -> Self {
        Substeps { limit, ..self }
    }

    /// Goes on to the end of the frame, or as far as the method can. The state is up to date in any case, t included.
    pub(crate) fn run(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        let outcome = self.advance(method, state);
        method.end(state);
        outcome
    }

    fn advance(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        while self.done < self.length {
            if self.is_hopeless() {
                return Ok(End::OutOfWork);
            }
            let substep = self.propose(method.longest(state));
            let outcome = method.attempt(state, substep.h, substep.end);
            match self.judge(outcome, method, state)? {
                Verdict::Singular => return Ok(End::Singular),
                Verdict::Rejected { growth } => {
                    self.reject(&substep, growth);
                    if self.is_too_short() {
                        return Err(self.not_satisfied(method, state, substep.end));
                    }
                    method.turn_back(state);
                }
                Verdict::Accepted { attempt, growth } => {
                    let substep = self.accept(substep, &attempt, growth);
                    let drift = method.keep(state, substep.h);
                    self.book(&substep, &attempt, &drift, state)?;
                    if let Some(watch) = &mut self.watch {
                        method.end(state);
                        watch.note(self.system, state);
                    }
                }
            }
        }
        Ok(End::Whole)
    }

    /// Whether the substeps are used up, or an eighth of them has come less than a quarter as far as it should.
    fn is_hopeless(&self) -> bool {
        let part = self.tried as f64 / self.limit as f64;
        self.tried >= self.limit || (self.tried >= 16 && part > 0.125 && 4.0 * self.done < part * self.length)
    }

    /// The next substep, no longer than the method's longest.
    fn propose(&mut self, longest: f64) -> Proposal {
        self.tried += 1;
        let h = fit(self.proposed.min(longest), self.length - self.done);
        let done = if h == self.length - self.done { self.length } else { self.done + h };
        Proposal { h, end: self.start + done, done }
    }

    /// Whether an attempt is accepted.
    ///
    /// # Errors
    /// A failure of the method; an error estimate that is not a number, which no shorter substep mends.
    fn judge(&self, outcome: Outcome, method: &impl Stepper, state: &State) -> Result<Verdict, StepError> {
        let attempt = match outcome {
            Outcome::Singular => return Ok(Verdict::Singular),
            Outcome::Failed(error) => return Err(error),
            Outcome::NotMet => return Ok(Verdict::Rejected { growth: HALF }),
            Outcome::Met(attempt) if attempt.error.is_nan() => return Err(self.not_finite(method, state)),
            Outcome::Met(attempt) => attempt,
        };
        let growth = method.growth(&attempt, self.settings);
        let is_accepted = accepts(attempt.error, self.settings);
        Ok(if is_accepted { Verdict::Accepted { attempt, growth } } else { Verdict::Rejected { growth } })
    }

    fn reject(&mut self, substep: &Proposal, growth: f64) {
        self.report.rejected += 1;
        self.proposed = substep.h * growth;
    }

    fn is_too_short(&self) -> bool {
        self.proposed < SHORTEST * self.length
    }

    /// The substep as it was met: shorter than proposed if an event ends it.
    fn accept(&mut self, substep: Proposal, attempt: &Attempt, growth: f64) -> Proposal {
        self.proposed = substep.h * growth;
        if attempt.h < substep.h {
            let done = self.done + attempt.h;
            return Proposal { h: attempt.h, end: self.start + done, done };
        }
        substep
    }

    /// Books a substep that was kept: in the state, in the report, and in how far the frame has come.
    ///
    /// # Errors
    /// More substeps than the settings allow; a frame with a limit of its own ends at that instead.
    fn book(
        &mut self,
        substep: &Proposal,
        attempt: &Attempt,
        drift: &Drift,
        state: &mut State,
    ) -> Result<(), StepError> {
        state.work.dissipation += attempt.dissipation;
        state.work.drives += attempt.drives;
        (self.done, state.t) = (substep.done, substep.end);
        self.report.book(substep.h, attempt.iterations, drift);
        let max_substeps = self.settings.max_substeps;
        if self.report.substeps >= max_substeps && self.done < self.length && self.limit == usize::MAX {
            return Err(StepError::TooManySubsteps { time: state.t, max_substeps });
        }
        Ok(())
    }

    /// The error that names the particle of the tried motion that is not finite.
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

    /// The error that names the row of the tried motion with the largest residual.
    fn not_satisfied(&self, method: &impl Stepper, state: &State, end: f64) -> StepError {
        let mut tried = state.clone();
        method.write_tried(&mut tried);
        in_dimension!(self.system.dimension, D => {
            let mut rows = self.system.empty_rows();
            self.system.evaluate_rows(Motion::<D> { q: &tried.q, qd: &tried.qd, t: end }, &mut rows);
            let (row, _) = worst_row(self.system, &rows.C);
            match rows.C.get(row) {
                Some(&residual) => {
                    StepError::NotSatisfied { time: state.t, row: self.system.row_names[row].clone(), residual }
                }
                None => self.not_finite(method, state),
            }
        })
    }

    /// Ends a frame that failed. The next frame, or the method that `auto` goes on with, needs the watch.
    pub(crate) fn fail(self, frame: &mut Frame<'_>, error: StepError) -> StepError {
        frame.workspace.watch = self.watch;
        error
    }

    /// Ends the frame: writes to the state the data that the next frame starts with, and returns the report. `lambda`
    /// is λ at the state, if the frame ended on the general path.
    pub(crate) fn finish(mut self, frame: &mut Frame<'_>, state: &mut State, lambda: Option<Vec<f64>>) -> StepReport {
        frame.workspace.watch = self.watch;
        let equation = &frame.workspace.equation;
        let (lambda, drives, deficient) = match lambda {
            Some(lambda) => {
                for warning in equation.warnings(self.system) {
                    self.report.warn(warning);
                }
                let drives = energy::drive_power(self.system, &equation.rows.Ct, &lambda);
                (lambda, drives, equation.solver.deficient)
            }
            None => (Vec::new(), 0.0, false),
        };
        state.carry = Some(Carry {
            lambda,
            substep: self.proposed,
            deficient,
            previous: None,
            collocation: None,
            drives,
            choice: None,
        });
        self.report.energy = energy::energy(self.system, state);
        self.report
    }
}

/// The whole remainder, half of it, or h: so that no sliver is left for the end of the frame.
fn fit(h: f64, remaining: f64) -> f64 {
    if h >= remaining {
        remaining
    } else if 2.0 * h > remaining {
        0.5 * remaining
    } else {
        h
    }
}
