//! One substep tried with a given length, and its event functions.

use super::EventStepper;
use crate::contact::{EventFunctions, rest_speed};
use crate::integrate::Workspace;
use crate::integrate::adaptive::{Attempt, Outcome, Stepper, accepts};
use crate::modes::Mode;
use crate::multiplier::Needed;
use crate::point::Motion;
use crate::settings::Feedback;
use crate::state::State;

/// Times that the directions of slow slips are aligned in one substep. Each time shrinks what they are off by the part
/// of w that rods and other contacts take away; of a free particle nothing is left after the first.
const ALIGNMENTS: usize = 20;

/// The largest K |d' − d| of directions that count as aligned, relative to the speed, in tolerances.
const ALIGNED: f64 = 1e-3;

/// Part of the error of a substep that is turned in its last alignment, below which the error is known well enough to
/// choose the next length by it.
const SETTLED: f64 = 0.1;

impl<const D: usize> EventStepper<'_, D> {
    /// Tries a substep of h, with directions of friction that follow their slip or turn to its direction at the
    /// end (`slip.rs`); if it is accepted, its event functions are at hand.
    pub(super) fn try_length(&mut self, state: &State, h: f64) -> Result<Attempt, Outcome> {
        self.turns = false;
        let rest_speed = rest_speed(&state.qd, &self.run.field.workspace.equation.WQ, self.frame);
        let equation = &mut self.run.field.workspace.equation;
        let turns = self.at_start.prepare::<D>(self.run.system, equation, (state.t, h), rest_speed);
        for _ in 0..ALIGNMENTS {
            // The first slope depends on the directions of this try.
            self.run.stages.is_first_known &= !turns;
            let attempt = match self.run.attempt(state, h, state.t + h) {
                Outcome::Met(attempt) if accepts(attempt.error, self.run.settings) => attempt,
                other => return Err(other),
            };
            // The least speed that counts is a length over the frame. Over h it would grow, since substeps shrink with
            // a slip that stops.
            let (speed, tolerance) = (self.run.speed(self.frame), self.run.settings.tolerance);
            let equation = &mut self.run.field.workspace.equation;
            let astray = self.at_start.align::<D>(self.run.system, equation, h, rest_speed);
            let is_aligned = astray.turned <= ALIGNED * tolerance * speed;
            let error = attempt.error.max(astray.across / speed);
            self.turns = error > attempt.error;
            if is_aligned && accepts(error, self.run.settings) {
                self.write_event_functions(state.t + h);
                return Ok(Attempt { error, ..attempt });
            }
            // More alignments would not make the substep acceptable.
            let is_hopeless = !accepts(error, self.run.settings) && astray.turned <= SETTLED * astray.across;
            if is_aligned || is_hopeless {
                return Err(Outcome::Met(Attempt { error, ..attempt }));
            }
            self.run.turn_back(state);
        }
        Err(Outcome::NotMet)
    }

    /// Event functions at the motion in the workspace, with λ there.
    pub(super) fn write_event_functions(&mut self, t: f64) {
        let EventStepper { run, modes, event_functions, frame, normals, .. } = self;
        let (system, settings, workspace) = (run.system, run.settings, &mut *run.field.workspace);
        let Workspace { equation, q, qd, reading, .. } = workspace;
        let motion = Motion::<D> { q, qd, t };
        let is_closed = modes.contacts.iter().any(|mode| mode.is_closed());
        let may_break = modes.broken.iter().any(|broken| !broken);
        if is_closed || may_break {
            equation.solve(system, motion, &Feedback::NONE, true, Needed::Forces);
        }
        let solved = equation.lambda.clone();
        equation.spread_over_contacts::<D>(system);
        let rest_speed = rest_speed(motion.qd, &equation.WQ, *frame);
        let functions = EventFunctions { system, settings, modes, rest_speed, normals };
        functions.write::<D>(equation, event_functions);
        // Links break by the force that redundant rows share, which is not the λ that decides modes.
        let lambda = std::mem::replace(&mut equation.lambda, solved);
        if may_break {
            reading.share_out::<D>(system, t, &Feedback::NONE, equation);
        }
        functions.add_breakables(&equation.lambda, event_functions);
        equation.lambda = lambda;
    }

    /// Accepts the slips of the substep tried last: they are the directions at the start of the next one.
    pub(super) fn keep_slips(&mut self) {
        for sliding in &mut self.run.field.workspace.equation.sliding {
            sliding.slip.start();
            self.modes.contacts[sliding.contact] = Mode::Sliding(sliding.slip);
        }
    }
}
