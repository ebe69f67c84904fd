//! A pair that stops at events: where a contact closes, opens, begins or ceases to slip, and where something breaks.
//!
//! Between events the modes of all contacts stand, and a substep is a substep of the pair. What is watched are the margins of
//! `switching/margins.rs`, all at least −1 while the modes are right.
//!
//! A substep at whose end one lies below −1 is tried again with a length at which the first of them is between −1 and 1: bracketed,
//! and found by the secant through the bracket's ends, kept off both (regula falsi), from the start of the substep every time. So an
//! event is as accurate as the method, whatever its order. A margin that turns negative and back within a substep is seen in the
//! middle, from the cubic through both ends; what is quicker than that is missed.

use super::Workspace;
use super::adaptive::{Attempt, MISSED, Method, Outcome};
use super::field::{Rows, pack};
use super::pair::Run;
use crate::error::StepError;
use crate::measure::Drift;
use crate::multiplier::{Beginning, Friction, Multipliers};
use crate::point::Motion;
use crate::report::Event;
use crate::settings::Feedback;
use crate::state::State;
use crate::switching::{Mode, Modes, Moment, Pace, TOUCHES, Trigger, first_violated, still, write_margins};

/// How near zero a margin must come that may be on either side of it: it costs an attempt more than 1 would, and leaves the time of
/// an impact good to 1e-12 of the extent over the speed.
const SHARP: f64 = 0.01;

/// Attempts at one event: the secant needed three to nine where it was watched, halving forty.
const ATTEMPTS: usize = 60;

/// Where a bracket is this part of the frame, its ends are the same time.
const SAME_TIME: f64 = 1e-13;

/// Events of one frame after which nothing bounces any more, and after which they are too many to be real.
const BOUNCING: usize = 1000;
const TOO_MANY: usize = 20_000;

/// A pair on its way over one frame of a system that switches.
pub(super) struct Switching<'a, const D: usize> {
    run: Run<'a, Rows<'a, D>>,
    /// Length of the frame [s].
    frame: f64,
    pub(super) events: Vec<Event>,
    count: usize,
    modes: Modes,
    /// What ends the substep tried last.
    trigger: Option<Trigger>,
    failure: Option<StepError>,
    margins: Vec<f64>,
    /// Those where the substep begins.
    at_beginning: Vec<f64>,
    beginning: Beginning,
}

impl<'a, const D: usize> Switching<'a, D> {
    /// From a state: the modes are decided anew, since between two frames anything may have changed.
    pub(super) fn begin(run: Run<'a, Rows<'a, D>>, state: &mut State, frame: f64) -> Result<Self, StepError> {
        let modes = state.modes.clone();
        let mut switching = Switching {
            run,
            frame,
            events: Vec::new(),
            count: 0,
            modes,
            trigger: None,
            failure: None,
            margins: Vec::new(),
            at_beginning: Vec::new(),
            beginning: Beginning::default(),
        };
        let workspace = &mut *switching.run.field.workspace;
        workspace.q.copy_from_slice(&state.q);
        workspace.qd.copy_from_slice(&state.qd);
        switching.react(state, state.t)?;
        Ok(switching)
    }

    /// What the modes must be now, and how fast everything goes on.
    fn react(&mut self, state: &mut State, t: f64) -> Result<(), StepError> {
        let (system, settings) = (self.run.system, self.run.settings);
        let workspace = &mut *self.run.field.workspace;
        let pace = Pace {
            touches: TOUCHES * settings.constraint_tolerance,
            rest: if self.count < BOUNCING { Some(1e-3 * self.frame) } else { None },
            frame: self.frame,
        };
        let before = self.modes.clone();
        let trigger = self.trigger.take();
        let Workspace { equation, q, qd, .. } = workspace;
        let outcome = Moment::<D> { equation, system, q, qd, t, pace }.react(&mut self.modes, trigger);
        let reaction = outcome.map_err(|jam| {
            let place = system.switches.contacts[jam.contact].constraint;
            StepError::Jammed { time: t, constraint: system.constraints[place].name.clone() }
        })?;
        state.work.dissipation -= reaction.lost;
        state.modes.clone_from(&self.modes);
        pack(&workspace.qd, &mut self.run.stages.qd);
        self.run.stages.is_first_known = false;
        self.run.field.is_factored = false;
        self.modes.write_events(&before, &reaction.impacts, (system, t), &mut self.events);
        let equation = &self.run.field.workspace.equation;
        self.beginning.Cd.clone_from(&equation.rows.Cd);
        self.beginning.lambda.clone_from(&equation.lambda);
        let Workspace { equation, q, qd, .. } = &mut *self.run.field.workspace;
        equation.constrain(system, Motion::<D> { q, qd, t });
        self.write_margins(t);
        self.at_beginning.clone_from(&self.margins);
        self.count += usize::from(trigger.is_some());
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
            // Friction had no answer.
            Outcome::Met(attempt) if attempt.error.is_nan() && !self.friction().is_empty() => Err(self.jam(state.t)),
            Outcome::Failed(StepError::NotSatisfied { residual, .. })
                if residual.is_nan() && !self.friction().is_empty() =>
            {
                Err(self.jam(state.t))
            }
            Outcome::Met(attempt) if attempt.error <= MISSED * self.run.settings.tolerance => {
                self.write_margins(state.t + h);
                Ok(attempt)
            }
            // No substep is so short that friction had an answer.
            Outcome::NotMet if h < SAME_TIME * self.frame && !self.friction().is_empty() => Err(self.jam(state.t)),
            other => Err(other),
        }
    }

    fn friction(&self) -> &Friction {
        &self.run.field.workspace.equation.friction
    }

    /// No friction force was found; of what slides, the first is named.
    fn jam(&self, time: f64) -> Outcome {
        let system = self.run.system;
        let normal = self.friction().sliding[0].normal;
        let contact = system.switches.contacts.iter().find(|contact| contact.normal == normal);
        let place = contact.map_or(0, |contact| contact.constraint);
        Outcome::Failed(StepError::Jammed { time, constraint: system.constraints[place].name.clone() })
    }

    fn write_margins(&mut self, t: f64) {
        let Switching { run, modes, margins, frame, .. } = self;
        let (system, workspace) = (run.system, &mut *run.field.workspace);
        let (equation, motion) = (&mut workspace.equation, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t });
        let is_closed = modes.contacts.iter().any(|mode| mode.is_closed());
        if is_closed || modes.broken.iter().any(|broken| !broken) {
            equation.solve(system, motion, &Feedback::NONE, true, Multipliers::Force);
        }
        margins.clear();
        write_margins(equation, system, run.settings, modes, still(motion.qd, &equation.WQ, *frame), margins);
    }

    /// Whether something open is closed in the middle of the substep tried last, by the cubic through its ends.
    fn is_missed(&mut self, h: f64, t: f64) -> bool {
        let (system, settings, workspace) = (self.run.system, self.run.settings, &mut *self.run.field.workspace);
        if !self.modes.contacts.contains(&Mode::Open) {
            return false;
        }
        let stages = &*self.run.stages;
        let coordinates = system.coordinate_count();
        let mut middle = vec![0.0; stages.q.len() * 8];
        for (k, middle) in middle.chunks_exact_mut(8).enumerate() {
            for (lane, x) in middle.iter_mut().enumerate() {
                let (q, qd) = (stages.q[k].0[lane], stages.qd[k].0[lane]);
                let (next_q, next_qd) = (stages.next_q[k].0[lane], stages.next_qd[k].0[lane]);
                *x = 0.5 * (q + next_q) + 0.125 * h * (qd - next_qd);
            }
        }
        let (equation, qd) = (&mut workspace.equation, &workspace.qd);
        equation.constrain(system, Motion::<D> { q: &middle[..coordinates], qd, t: t + 0.5 * h });
        let open = system.switches.contacts.iter().zip(&self.modes.contacts).filter(|(_, mode)| !mode.is_closed());
        let mut rows = open.map(|(contact, _)| contact.normal);
        let is_missed = rows.any(|row| equation.gaps.C[row] < -settings.constraint_tolerance * system.row_scale[row]);
        equation.constrain(system, Motion::<D> { q: &workspace.q, qd, t: t + h });
        is_missed
    }

    /// The length at which the first margin is met, between 0 and `high`, at which some are not.
    fn locate(&mut self, state: &State, mut high: f64) -> Result<(f64, Attempt), Outcome> {
        let mut low = 0.0;
        let mut at_low = self.at_beginning.clone();
        let mut at_high = self.margins.clone();
        let mut weight = 1.0;
        let mut was_low = false;
        for _ in 0..ATTEMPTS {
            let first = first_violated(&at_high);
            let is_two_sided = Trigger::of(first, self.modes.contacts.len()).is_two_sided(&self.modes);
            // Aimed at the middle of what is allowed.
            let aim = if is_two_sided { 0.0 } else { 0.5 };
            let (g_low, g_high) = ((at_low[first] + aim).max(0.1 * SHARP), at_high[first] + aim);
            // The end that stays for the second time counts half.
            let (g_low, g_high) = if was_low { (g_low, weight * g_high) } else { (weight * g_low, g_high) };
            let middle = if g_low.is_finite() { g_low / (g_low - g_high) } else { 0.5 };
            let h = low + middle.clamp(1e-3, 1.0 - 1e-3) * (high - low);
            let attempt = self.try_length(state, h)?;
            let is_violated = self.margins.iter().any(|&margin| margin < -1.0);
            // What opens, slips or breaks must be past the point, so that it is not taken back.
            let margin = self.margins[first];
            let is_there = !is_violated && margin <= if is_two_sided { SHARP } else { 0.0 };
            if is_there || high - low < SAME_TIME * self.frame {
                self.trigger = Some(Trigger::of(first, self.modes.contacts.len()));
                return Ok((h, attempt));
            }
            weight = if is_violated != was_low { 0.5 * weight } else { 1.0 };
            was_low = !is_violated;
            if is_violated {
                high = h;
                at_high.clone_from(&self.margins);
            } else {
                low = h;
                at_low.clone_from(&self.margins);
            }
        }
        Err(Outcome::NotMet)
    }
}

impl<const D: usize> Method for Switching<'_, D> {
    fn estimate_order(&self) -> f64 {
        self.run.estimate_order()
    }

    fn longest(&mut self, state: &State) -> f64 {
        let equation = &self.run.field.workspace.equation;
        let slow = still(&state.qd, &equation.WQ, self.frame);
        let slips =
            equation.friction.longest::<D>(&self.beginning, &equation.rows, &self.run.system.inverse_mass, slow);
        slips.max(1e-6 * self.frame).min(self.run.longest(state))
    }

    fn attempt(&mut self, state: &State, h: f64, _: f64) -> Outcome {
        if let Some(error) = self.failure.take() {
            return Outcome::Failed(error);
        }
        self.trigger = None;
        let whole = match self.try_length(state, h) {
            Ok(whole) => whole,
            Err(outcome) => return outcome,
        };
        if self.margins.iter().any(|&margin| margin < -1.0) {
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
        if self.trigger.is_some() {
            let outcome = self.react(state, state.t + h);
            self.failure = outcome.err();
        } else {
            self.at_beginning.clone_from(&self.margins);
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
