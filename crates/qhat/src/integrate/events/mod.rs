//! A pair that stops at events: where a contact closes, opens, begins or ceases to slip, and where something breaks.
//!
//! Between events the modes of all contacts stand, and a substep is a substep of the pair. What is watched are the margins of
//! `contact/event_functions.rs`, all at least −1 while the modes are right.
//!
//! A substep at whose end one lies below −1 is tried again with a length at which the first of them is between −1 and 1 (`locate.rs`).

mod locate;

use super::Workspace;
use super::adaptive::pair::PairStepper;
use super::adaptive::{Attempt, MISSED, Outcome, Stepper};
use super::field::{Field, GeneralField, pack, unpack};
use crate::contact::{
    EventCause, EventResolution, Normals, RestThresholds, TOUCH_DISTANCE, rest_speed, write_event_functions,
    write_events,
};
use crate::drift::Drift;
use crate::error::StepError;
use crate::modes::{Mode, Modes};
use crate::multiplier::{Beginning, Friction, SolveFor};
use crate::point::Motion;
use crate::report::Event;
use crate::settings::Feedback;
use crate::state::State;

/// The length of a substep past a point at which a force is not defined, in frames: ten times what `locate.rs` takes for one time.
/// What falls that long has not moved.
const SKIP: f64 = 1e-12;

/// A substep shorter than this part of the frame will not do where a longer one did not, because friction has no answer: above `SHORTEST`.
const NO_ANSWER: f64 = 1e-11;

/// The shortest substep for the sake of a rest_speed slip that turns, in frames: it is dissipative whichever way it goes.
const SLOWEST: f64 = 1e-4;

/// Events of one frame after which nothing bounces any more, and after which they are too many to be real.
const BOUNCING: usize = 1000;
const TOO_MANY: usize = 20_000;

/// A pair on its way over one frame of a system that contacts.
pub(super) struct EventStepper<'a, const D: usize> {
    run: PairStepper<'a, GeneralField<'a, D>>,
    /// Length of the frame [s].
    frame: f64,
    pub(super) events: Vec<Event>,
    count: usize,
    modes: Modes,
    /// What ends the substep tried last.
    cause: Option<EventCause>,
    /// Whether that happens where it began.
    stays: bool,
    /// A contact that is let go for one short substep, to come past a point at which its force is not defined.
    skipped: Option<usize>,
    failure: Option<StepError>,
    event_functions: Vec<f64>,
    /// Those where the substep begins.
    at_beginning: Vec<f64>,
    beginning: Beginning,
    normals: Normals,
}

impl<'a, const D: usize> EventStepper<'a, D> {
    /// From a state: the modes are decided anew, since between two frames anything may have changed.
    pub(super) fn begin(
        run: PairStepper<'a, GeneralField<'a, D>>,
        state: &mut State,
        frame: f64,
    ) -> Result<Self, StepError> {
        let modes = state.modes.clone();
        let mut switching = EventStepper {
            run,
            frame,
            events: Vec::new(),
            count: 0,
            modes,
            cause: None,
            stays: false,
            skipped: None,
            failure: None,
            event_functions: Vec::new(),
            at_beginning: Vec::new(),
            beginning: Beginning::default(),
            normals: Normals::default(),
        };
        let workspace = &mut *switching.run.field.workspace;
        workspace.q.copy_from_slice(&state.q);
        workspace.qd.copy_from_slice(&state.qd);
        switching.resolve(state, state.t)?;
        Ok(switching)
    }

    /// What the modes must be now, and how fast everything goes on.
    fn resolve(&mut self, state: &mut State, t: f64) -> Result<(), StepError> {
        let (system, settings) = (self.run.system, self.run.settings);
        let workspace = &mut *self.run.field.workspace;
        let thresholds = RestThresholds {
            touch_distance: TOUCH_DISTANCE * settings.constraint_tolerance,
            shortest_flight: if self.count < BOUNCING { Some(1e-3 * self.frame) } else { None },
            frame: self.frame,
        };
        let before = self.modes.clone();
        let cause = self.cause.take();
        if let Some(EventCause::Singular(contact)) = cause {
            self.skipped = Some(contact);
        }
        let Workspace { equation, q, qd, .. } = workspace;
        let outcome = EventResolution::<D> { equation, system, q, qd, t, thresholds }.resolve(&mut self.modes, cause);
        let resolved = outcome.map_err(|failure| {
            let place = system.contacts.list[failure.contact].constraint;
            StepError::Jammed { time: t, constraint: system.constraints[place].name.clone() }
        })?;
        state.work.dissipation -= resolved.lost;
        state.modes.clone_from(&self.modes);
        pack(&workspace.qd, &mut self.run.stages.qd);
        self.run.stages.is_first_known = false;
        self.run.field.is_factored = false;
        write_events((&before, &self.modes), &resolved.impacts, (system, t), &mut self.events);
        let equation = &self.run.field.workspace.equation;
        self.beginning.Cd.clone_from(&equation.rows.Cd);
        self.beginning.lambda.clone_from(&equation.lambda);
        let Workspace { equation, q, qd, .. } = &mut *self.run.field.workspace;
        equation.constrain(system, Motion::<D> { q, qd, t });
        self.normals.begin::<D>(&equation.rows);
        self.write_event_functions(t);
        self.at_beginning.clone_from(&self.event_functions);
        self.count += usize::from(cause.is_some());
        if self.count >= TOO_MANY {
            return Err(StepError::TooManyEvents { time: t, events: self.count });
        }
        Ok(())
    }

    /// Tries a substep; its margins are at hand if it is good.
    fn try_length(&mut self, state: &State, h: f64) -> Result<Attempt, Outcome> {
        let equation = &mut self.run.field.workspace.equation;
        equation.friction.prepare::<D>(&self.beginning, &equation.rows, &self.run.system.inverse_mass, h);
        match self.run.attempt(state, h, state.t + h) {
            Outcome::Met(attempt) if attempt.error <= MISSED * self.run.settings.tolerance => {
                self.write_event_functions(state.t + h);
                Ok(attempt)
            }
            other => Err(other),
        }
    }

    /// What slides and has lost its force, if anything slides.
    fn without_answer(&self) -> Option<EventCause> {
        let normal = self.friction().sliding.first()?.normal;
        self.run.system.contacts.list.iter().position(|contact| contact.normal == normal).map(EventCause::Singular)
    }

    /// Stays where the substep began; what ends it there happens at once.
    fn stay(&mut self, state: &State, cause: EventCause) -> Outcome {
        self.run.turn_back(state);
        let PairStepper { field, stages, .. } = &mut self.run;
        unpack(&stages.q, &mut field.workspace.q);
        unpack(&stages.qd, &mut field.workspace.qd);
        (self.cause, self.stays) = (Some(cause), true);
        Outcome::Met(Attempt { h: 0.0, error: 0.0, iterations: 0, dissipation: 0.0, drives: 0.0 })
    }

    fn friction(&self) -> &Friction {
        &self.run.field.workspace.equation.friction
    }

    fn write_event_functions(&mut self, t: f64) {
        let EventStepper { run, modes, event_functions, frame, normals, .. } = self;
        let (system, workspace) = (run.system, &mut *run.field.workspace);
        let (equation, motion) = (&mut workspace.equation, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t });
        let is_closed = modes.contacts.iter().any(|mode| mode.is_closed());
        if is_closed || modes.broken.iter().any(|broken| !broken) {
            equation.solve(system, motion, &Feedback::NONE, true, SolveFor::Force);
        }
        event_functions.clear();
        let rest_speed = rest_speed(motion.qd, &equation.WQ, *frame);
        write_event_functions::<D>(equation, system, run.settings, modes, (rest_speed, normals), event_functions);
    }
}

impl<const D: usize> Stepper for EventStepper<'_, D> {
    fn estimate_order(&self) -> f64 {
        self.run.estimate_order()
    }

    fn longest(&mut self, state: &State) -> f64 {
        let equation = &self.run.field.workspace.equation;
        let rest_speed = rest_speed(&state.qd, &equation.WQ, self.frame);
        let slips =
            equation.friction.longest::<D>(&self.beginning, &equation.rows, &self.run.system.inverse_mass, rest_speed);
        slips.max(SLOWEST * self.frame).min(self.run.longest(state))
    }

    fn attempt(&mut self, state: &State, h: f64, _: f64) -> Outcome {
        if let Some(error) = self.failure.take() {
            return Outcome::Failed(error);
        }
        (self.cause, self.stays) = (None, false);
        if let Some(contact) = self.skipped.take() {
            let h = h.min(SKIP * self.frame);
            self.cause = Some(EventCause::Normal(contact));
            return self.try_length(state, h).map_or_else(|outcome| outcome, Outcome::Met);
        }
        let whole = match (self.try_length(state, h), self.without_answer()) {
            (Ok(whole), _) => whole,
            (Err(_), Some(cause)) if h < NO_ANSWER * self.frame => return self.stay(state, cause),
            // Shorter ones may have one.
            (Err(Outcome::Met(attempt)), Some(_)) if attempt.error.is_nan() => return Outcome::NotMet,
            (Err(Outcome::Failed(StepError::NotSatisfied { residual, .. })), Some(_)) if residual.is_nan() => {
                return Outcome::NotMet;
            }
            (Err(outcome), _) => return outcome,
        };
        if self.event_functions.iter().any(|&margin| margin < -1.0) {
            return match self.locate(state, h) {
                Ok((h, attempt)) => Outcome::Met(Attempt { h, error: whole.error, ..attempt }),
                Err(outcome) => outcome,
            };
        }
        // Half of it, and what it meets there, or an event before.
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
        // In their order there is one for each contact that slides.
        let mut sliding = self.run.field.workspace.equation.friction.sliding.iter_mut();
        for mode in &mut self.modes.contacts {
            if let Mode::Sliding(direction) = mode
                && let Some(now) = sliding.next()
            {
                now.began = now.direction;
                *direction = now.direction;
            }
        }
        let equation = &self.run.field.workspace.equation;
        self.beginning.Cd.clone_from(&equation.gaps.Cd);
        self.beginning.lambda.clone_from(&equation.lambda);
        if self.cause.is_some() {
            let outcome = self.resolve(state, state.t + h);
            self.failure = outcome.err();
        } else {
            self.normals.begin::<D>(&self.run.field.workspace.equation.rows);
            self.at_beginning.clone_from(&self.event_functions);
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
