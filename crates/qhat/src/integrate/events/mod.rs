//! EventStepper: an embedded pair whose substeps end at events, where a contact closes, opens, begins or ceases to
//! slip, and where a constraint breaks.
//!
//! Between events the modes of all contacts stand, and a substep is a substep of the pair. The event functions of
//! `contact/event_functions.rs` are all at least −1 while the modes are right. If one of them is below −1 at the end of
//! a substep, the substep is tried again with a length at which none is below −1 and the first is back near zero
//! (`locate.rs`). There `contact/resolution.rs` decides how the motion goes on. `trial.rs` tries one length, and
//! `slip.rs` gives friction its direction within a substep.

mod locate;
mod slip;
mod trial;

use super::Workspace;
use super::adaptive::pair::PairStepper;
use super::adaptive::{Attempt, Outcome, Stepper};
use super::field::{Field, GeneralField, pack, unpack};
use crate::contact::{EventCause, EventResolution, Normals, RestThresholds, TOUCH_DISTANCE};
use crate::drift::Drift;
use crate::error::StepError;
use crate::modes::Modes;
use crate::point::Motion;
use crate::report::{Event, Warning};
use crate::state::State;
use slip::AtStart;

/// Length of a substep past a point at which a force is not defined, in frames: ten times what `locate.rs` takes for
/// one time. A fall of that length does not move anything.
const SKIP: f64 = 1e-12;

/// Length of a substep, in frames, below which friction without an answer is taken to stay without one: above
/// `SHORTEST` of the frame loop.
const NO_ANSWER: f64 = 1e-11;

/// The power of h with which the error of a direction that turns evenly grows, at least.
const TURNING_ORDER: f64 = 2.0;

/// Events of one frame after which no impact bounces any more.
const BOUNCING: usize = 1000;

/// Events of one frame after which the step fails: a number that no motion has.
const TOO_MANY: usize = 20_000;

/// A pair under way over one frame of a system with contacts.
pub(super) struct EventStepper<'a, const D: usize> {
    run: PairStepper<'a, GeneralField<'a, D>>,
    /// Length of the frame [s].
    frame: f64,
    pub(super) events: Vec<Event>,
    pub(super) warnings: Vec<Warning>,
    /// Events resolved in this frame.
    count: usize,
    /// The modes at the start of the substep.
    modes: Modes,
    /// The event that ends the substep tried last.
    cause: Option<EventCause>,
    /// Whether that event is at the start of the substep, which then has no length.
    stays: bool,
    /// A contact that is open for one short substep, to pass a point at which its force is not defined.
    skipped: Option<usize>,
    /// A resolution that failed; the next attempt returns it.
    failure: Option<StepError>,
    /// Event functions at the end of the substep tried last, and at its start.
    event_functions: Vec<f64>,
    event_functions_at_start: Vec<f64>,
    /// Ċ, λ and J at the start of the substep.
    at_start: AtStart,
    normals: Normals,
    /// Whether the error of the substep tried last is that of a direction of friction that turned.
    turns: bool,
}

impl<'a, const D: usize> EventStepper<'a, D> {
    /// From a state. The modes are decided again, since anything may have changed between two frames.
    pub(super) fn begin(
        run: PairStepper<'a, GeneralField<'a, D>>,
        state: &mut State,
        frame: f64,
    ) -> Result<Self, StepError> {
        let mut stepper = EventStepper {
            run,
            frame,
            events: Vec::new(),
            warnings: Vec::new(),
            count: 0,
            modes: state.modes.clone(),
            cause: None,
            stays: false,
            skipped: None,
            failure: None,
            event_functions: Vec::new(),
            event_functions_at_start: Vec::new(),
            at_start: AtStart::default(),
            normals: Normals::default(),
            turns: false,
        };
        let workspace = &mut *stepper.run.field.workspace;
        workspace.q.copy_from_slice(&state.q);
        workspace.qd.copy_from_slice(&state.qd);
        stepper.resolve(state, state.t)?;
        Ok(stepper)
    }

    /// Resolves the event at hand, if any: decides the modes and the velocities with which the motion goes on from t.
    fn resolve(&mut self, state: &mut State, t: f64) -> Result<(), StepError> {
        let (system, settings) = (self.run.system, self.run.settings);
        let workspace = &mut *self.run.field.workspace;
        let thresholds = RestThresholds {
            touch_distance: TOUCH_DISTANCE * settings.constraint_tolerance,
            shortest_flight: if self.count < BOUNCING { Some(1e-3 * self.frame) } else { None },
            frame: self.frame,
        };
        let cause = self.cause.take();
        if let Some(EventCause::Singular(k)) = cause {
            self.skipped = Some(k);
        }
        let Workspace { equation, q, qd, .. } = workspace;
        let outcome = EventResolution::<D> { equation, system, q, qd, t, thresholds }.resolve(&mut self.modes, cause);
        let mut resolved = outcome.map_err(|failure| {
            let place = system.contacts.list[failure.contact].constraint;
            StepError::Jammed { time: t, constraint: system.constraints[place].name.clone() }
        })?;
        state.work.dissipation -= resolved.lost;
        state.modes.clone_from(&self.modes);
        pack(&workspace.qd, &mut self.run.stages.qd);
        self.run.stages.is_first_known = false;
        self.run.field.is_factored = false;
        self.events.append(&mut resolved.events);
        self.warnings.append(&mut resolved.warnings);
        // The start of the next substep. The resolution evaluated all rows; `constrain` masks the inactive ones.
        self.run.field.follow(t, &mut state.feet);
        let Workspace { equation, q, qd, .. } = &mut *self.run.field.workspace;
        self.at_start.Cd.clone_from(&equation.rows.Cd);
        self.at_start.lambda.clone_from(&equation.lambda);
        equation.constrain(system, Motion::<D> { q, qd, t });
        self.normals.begin(&equation.rows);
        self.write_event_functions(t);
        self.event_functions_at_start.clone_from(&self.event_functions);
        self.count += usize::from(cause.is_some());
        if self.count >= TOO_MANY {
            return Err(StepError::TooManyEvents { time: t, events: self.count });
        }
        Ok(())
    }

    /// The first sliding contact as one whose force has no answer, if any contact slides.
    fn without_answer(&self) -> Option<EventCause> {
        let sliding = self.run.field.workspace.equation.sliding.first()?;
        Some(EventCause::Singular(sliding.contact))
    }

    /// A substep without a length: its event is resolved where the substep began.
    fn stay(&mut self, state: &State, cause: EventCause) -> Outcome {
        self.run.turn_back(state);
        let PairStepper { field, stages, .. } = &mut self.run;
        unpack(&stages.q, &mut field.workspace.q);
        unpack(&stages.qd, &mut field.workspace.qd);
        (self.cause, self.stays) = (Some(cause), true);
        Outcome::Met(Attempt { h: 0.0, error: 0.0, iterations: 0, dissipation: 0.0, drives: 0.0 })
    }
}

impl<const D: usize> Stepper for EventStepper<'_, D> {
    fn estimate_order(&self) -> f64 {
        if self.turns { TURNING_ORDER } else { self.run.estimate_order() }
    }

    fn longest(&mut self, state: &State) -> f64 {
        self.run.longest(state)
    }

    fn across(&mut self, state: &State, h: f64, remaining: f64) -> Option<f64> {
        self.run.across(state, h, remaining)
    }

    fn attempt(&mut self, state: &State, h: f64, _: f64) -> Outcome {
        if let Some(error) = self.failure.take() {
            return Outcome::Failed(error);
        }
        (self.cause, self.stays) = (None, false);
        if let Some(k) = self.skipped.take() {
            let h = h.min(SKIP * self.frame);
            self.cause = Some(EventCause::Normal(k));
            return self.try_length(state, h).map_or_else(|outcome| outcome, Outcome::Met);
        }
        let whole = match (self.try_length(state, h), self.without_answer()) {
            (Ok(whole), _) => whole,
            (Err(_), Some(cause)) if h < NO_ANSWER * self.frame => return self.stay(state, cause),
            // A λ that is not a number: friction may have an answer in a shorter substep.
            (Err(Outcome::Met(attempt)), Some(_)) if attempt.error.is_nan() => return Outcome::NotMet,
            (Err(outcome), _) => return outcome,
        };
        if self.event_functions.iter().any(|&function| function < -1.0) {
            return match self.locate(state, h) {
                Ok((h, attempt)) => Outcome::Met(Attempt { h, error: whole.error, ..attempt }),
                Err(outcome) => outcome,
            };
        }
        // A contact that closes and opens within the substep: half the substep ends closed, or at an event before that.
        if self.is_missed(h, state.t) {
            return Outcome::NotMet;
        }
        Outcome::Met(whole)
    }

    fn keep(&mut self, state: &mut State, h: f64) -> Drift {
        if self.stays {
            self.failure = self.resolve(state, state.t).err();
            return self.run.field.drift(&self.run.stages.q, &self.run.stages.qd);
        }
        let drift = self.run.keep(state, h);
        self.keep_slips();
        let equation = &self.run.field.workspace.equation;
        self.at_start.Cd.clone_from(&equation.gaps.Cd);
        self.at_start.lambda.clone_from(&equation.lambda);
        if self.cause.is_some() {
            let outcome = self.resolve(state, state.t + h);
            self.failure = outcome.err();
        } else {
            self.normals.begin(&self.run.field.workspace.equation.rows);
            self.event_functions_at_start.clone_from(&self.event_functions);
        }
        state.modes.clone_from(&self.modes);
        drift
    }

    fn turn_back(&mut self, state: &State) {
        self.run.turn_back(state);
    }

    fn end(&mut self, state: &mut State) {
        self.run.end(state);
    }

    fn write_tried(&self, state: &mut State) {
        self.run.write_tried(state);
    }
}
