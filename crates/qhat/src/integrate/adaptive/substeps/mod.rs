//! The frame loop: propose a substep, attempt it, judge it, reject it or accept and book it. `culprit.rs` finds the
//! error of a frame whose shortest substep was not kept.

mod culprit;

use super::acceptance::{Refusal, accepts};
use super::pace::{Pace, Steady};
use super::{Attempt, Outcome, Stepper};
use crate::drift::Drift;
use crate::energy;
use crate::error::StepError;
use crate::integrate::frame::Frame;
use crate::integrate::watch::TensionWatch;
use crate::multiplier::APPROACH;
use crate::report::StepReport;
use crate::settings::Settings;
use crate::space::in_dimension;
use crate::state::{Carry, State, SteadyMemory};
use crate::system::System;

/// Length of a substep, in frames, below which shortening it does not help.
const SHORTEST: f64 = 1e-12;

/// The same at an edge, which no substep passes: nearer to it, roundoff decides how the motion goes on.
const NEAR_EDGE: f64 = 1e-6;

/// Part of the substep by which a substep that does not meet the constraints is tried again.
const HALF: f64 = 0.5;

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
    /// Whether its length was chosen for a reason other than its error.
    is_placed: bool,
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
    pace: Pace,
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
        let pace = Pace::Free(state.carry.as_ref().map_or(length, |carry| carry.substep));
        let (done, tried, limit) = (0.0, 0, usize::MAX);
        Substeps { system, settings, start: state.t, length, done, limit, tried, pace, report, watch }
    }

    /// The same at a steady pace, which goes on as the carry of the state says.
    pub(crate) fn steadily(self, carry: Option<&Carry>) -> Self {
        let allowed = carry.map_or(f64::INFINITY, |carry| carry.substep);
        let memory = carry.map(|carry| carry.steady.clone()).unwrap_or_default();
        Substeps { pace: Pace::Steady(Steady::new(self.length, allowed, memory)), ..self }
    }

    /// The same with at most `limit` substeps, or as many as show that these will not do.
    pub(crate) fn within(self, limit: usize) -> Self {
        Substeps { limit, ..self }
    }

    /// Goes on to the end of the frame, or as far as the method can. The state is up to date in any case, t included.
    pub(crate) fn run(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        let outcome = self.advance(method, state);
        method.end(state);
        outcome.map_err(|error| match error {
            // Substeps without end are a symptom.
            StepError::TooManySubsteps { .. } => self.culprit_of_many(state).unwrap_or(error),
            other => other,
        })
    }

    fn advance(&mut self, method: &mut impl Stepper, state: &mut State) -> Result<End, StepError> {
        while self.done < self.length {
            if self.is_hopeless() {
                return Ok(End::OutOfWork);
            }
            let longest = method.longest(state);
            let across = match self.pace {
                Pace::Free(next) => method.across(state, next.min(longest), self.length - self.done),
                Pace::Steady(_) => None,
            };
            let substep = self.propose(longest, across);
            let outcome = method.attempt(state, substep.h, substep.end);
            let refusal = if let Outcome::Refused(refusal) = outcome { Some(refusal) } else { None };
            match self.judge(outcome, method)? {
                Verdict::Singular => return Ok(End::Singular),
                Verdict::Rejected { growth } => {
                    let shortest = if refusal == Some(Refusal::Edge) { NEAR_EDGE } else { SHORTEST };
                    if self.reject(&substep, growth) < shortest * self.length {
                        // The error is about the last good motion, which the method may have kept to itself.
                        method.end(state);
                        return Err(self.failure(method, state, substep.end, refusal));
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

    /// The next substep, no longer than the method's longest; or the one that leads across a singular position.
    fn propose(&mut self, longest: f64, across: Option<f64>) -> Proposal {
        self.tried += 1;
        let remaining = self.length - self.done;
        let whole = |h: f64, done: f64| if h == remaining { self.length } else { done };
        let (h, done) = match (&mut self.pace, across) {
            (Pace::Free(_), Some(h)) => (h.min(remaining), whole(h.min(remaining), self.done + h)),
            (Pace::Free(next), None) => {
                let h = fit(next.min(longest), remaining);
                (h, whole(h, self.done + h))
            }
            (Pace::Steady(steady), _) => steady.propose(longest),
        };
        Proposal { h, is_placed: across.is_some(), end: self.start + done, done }
    }

    /// Whether an attempt is accepted.
    ///
    /// # Errors
    /// A failure of the method.
    fn judge(&self, outcome: Outcome, method: &impl Stepper) -> Result<Verdict, StepError> {
        let attempt = match outcome {
            Outcome::Singular => return Ok(Verdict::Singular),
            Outcome::Failed(error) => return Err(error),
            Outcome::NotMet | Outcome::Refused(_) => return Ok(Verdict::Rejected { growth: HALF }),
            Outcome::Met(attempt) if attempt.error.is_nan() => return Ok(Verdict::Rejected { growth: HALF }),
            Outcome::Met(attempt) => attempt,
        };
        let growth = method.growth(&attempt, self.settings);
        let is_accepted = accepts(attempt.error, self.settings);
        Ok(if is_accepted { Verdict::Accepted { attempt, growth } } else { Verdict::Rejected { growth } })
    }

    /// Books a rejection. Returns the length to try next [s].
    fn reject(&mut self, substep: &Proposal, growth: f64) -> f64 {
        self.report.rejected += 1;
        match &mut self.pace {
            Pace::Free(next) => {
                *next = substep.h * growth;
                *next
            }
            Pace::Steady(steady) => steady.shorten(),
        }
    }

    /// The substep as it was met: shorter than proposed if an event ends it.
    fn accept(&mut self, substep: Proposal, attempt: &Attempt, growth: f64) -> Proposal {
        match &mut self.pace {
            Pace::Free(next) if substep.is_placed => *next = next.max(substep.h * growth),
            Pace::Free(next) => *next = substep.h * growth,
            Pace::Steady(steady) => steady.accept(attempt.error, self.settings.tolerance),
        }
        if attempt.h < substep.h {
            let done = self.done + attempt.h;
            return Proposal { h: attempt.h, end: self.start + done, done, ..substep };
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

    /// Ends a frame that failed. The next frame, or the method that `auto` goes on with, needs the watch.
    pub(crate) fn fail(self, frame: &mut Frame<'_>, error: StepError) -> StepError {
        frame.workspace.watch = self.watch;
        error
    }

    /// Ends the frame: writes to the state the data that the next frame starts with, and returns the report. `lambda`
    /// is λ at the state, if the frame ended on the general path.
    pub(crate) fn finish(mut self, frame: &mut Frame<'_>, state: &mut State, lambda: Option<Vec<f64>>) -> StepReport {
        frame.workspace.watch = self.watch;
        let equation = &mut frame.workspace.equation;
        let (lambda, drives, is_nearly_singular) = match lambda {
            Some(lambda) => {
                for warning in equation.warnings(self.system) {
                    self.report.warn(warning);
                }
                let drives = energy::drive_power(self.system, &equation.rows.Ct, &lambda);
                let margin = in_dimension!(self.system.dimension, D => {
                    state.rank = equation.rank_to_keep::<D>(self.system);
                    equation.margin::<D>(self.system)
                });
                (lambda, drives, margin.is_none_or(|margin| margin < APPROACH))
            }
            None => (Vec::new(), 0.0, false),
        };
        let (substep, steady) = match self.pace {
            Pace::Free(next) => (next, SteadyMemory::default()),
            Pace::Steady(steady) => (steady.allowed, steady.memory),
        };
        let carry = Carry { lambda, substep, steady, is_nearly_singular, drives, ..Carry::default() };
        state.carry = Some(carry);
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
