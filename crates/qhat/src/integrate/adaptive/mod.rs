//! Adaptive methods: a frame in substeps whose length follows an error estimate.
//!
//! `substeps/` is the frame loop, the same for every method; a method is a [`Stepper`]. `control.rs` bounds the length
//! of a substep. `pair.rs` is the stepper of embedded Runge–Kutta pairs, `pair_frame.rs` their frame. The other
//! steppers are RATTLE (`integrate/rattle.rs`), Radau IIA (`integrate/radau/`), and pairs with events
//! (`integrate/events/`).

mod acceptance;
pub(crate) mod control;
mod crossing;
pub(crate) mod dop853;
pub(crate) mod dopri5;
mod pace;
pub(crate) mod pair;
pub(crate) mod pair_frame;
mod substeps;

pub(crate) use acceptance::{Refusal, accepts, accepts_move};
pub(crate) use substeps::{End, Substeps};

use super::frame::Frame;
use crate::drift::Drift;
use crate::error::StepError;
use crate::multiplier::Equation;
use crate::point::Motion;
use crate::settings::{Feedback, Settings};
use crate::state::{Carry, State};
use crate::system::System;

/// One method, under way over one frame. It may keep the motion in arrays of its own until `end`.
///
/// The frame loop calls `longest`, then `attempt`; then `keep` if the substep is accepted, or `turn_back` if it is
/// rejected.
pub(crate) trait Stepper {
    /// The power of h with which the error estimate grows.
    fn estimate_order(&self) -> f64;

    /// The longest substep worth trying from here [s].
    fn longest(&mut self, state: &State) -> f64;

    /// The length of the next substep [s] where the motion comes to a singular position within about h, of the frame's
    /// `remaining` time; `None` elsewhere.
    fn across(&mut self, _state: &State, _h: f64, _remaining: f64) -> Option<f64> {
        None
    }

    /// Tries one substep of h, which brings t to `end`. A substep whose error is not accepted need not be finished.
    fn attempt(&mut self, state: &State, h: f64, end: f64) -> Outcome;

    /// The factor from the length of this substep to that of the next.
    fn growth(&self, attempt: &Attempt, settings: &Settings) -> f64 {
        control::growth(attempt.error, settings.tolerance, self.estimate_order())
    }

    /// Makes the substep tried last the motion at hand; h is its length. Returns its drift from C = 0 and Ċ = 0.
    fn keep(&mut self, state: &mut State, h: f64) -> Drift;

    /// Returns to the start of the substep tried last.
    fn turn_back(&mut self, state: &State);

    /// Writes the motion at hand to the state.
    fn end(&mut self, state: &mut State);

    /// Writes the motion tried last to a state, so that an error can name what went wrong in it.
    fn write_tried(&self, state: &mut State);
}

/// The outcome of the attempt at one substep.
pub(crate) enum Outcome {
    /// The constraints are met, or the error is too large for them to matter.
    Met(Attempt),
    /// The constraints are not met: a shorter substep may do.
    NotMet,
    /// The substep fails another condition of `acceptance.rs`: a shorter one may not.
    Refused(Refusal),
    /// A is singular on this path; the caller falls back to the general one.
    Singular,
    /// No substep of any length will do.
    Failed(StepError),
}

/// One substep that met the constraints.
pub(crate) struct Attempt {
    /// Its length [s]: less than what was tried where an event ends it.
    pub(crate) h: f64,
    /// Error estimate, relative to the extent of the system: the unit of the tolerance.
    pub(crate) error: f64,
    /// Newton iterations on C(q) = 0.
    pub(crate) iterations: usize,
    /// Work of forces without a potential [J].
    pub(crate) dissipation: f64,
    /// Work of driven constraints [J].
    pub(crate) drives: f64,
}

/// λ at the state: that of the last frame, or for a first one that of the equation. Leaves rows, forces and the
/// factor of A at the state; a factor that is at hand is kept.
pub(crate) fn begin<const D: usize>(frame: &mut Frame<'_>, state: &State, carry: Option<Carry>) -> Vec<f64> {
    let (system, workspace) = (frame.system, &mut *frame.workspace);
    workspace.set_modes(system, state);
    let Some(carry) = carry.filter(|carry| carry.lambda.len() == system.all_row_count()) else {
        return workspace.solve::<D>(system, state, &Feedback::NONE).lambda.clone();
    };
    let is_factored = workspace.is_factored_at(state);
    let equation = &mut workspace.equation;
    // Reading terms between frames, or starting from a saved state, must not change a bit of the motion that follows.
    if is_factored {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        equation.apply_forces(system, motion);
        equation.constrain(system, motion);
    } else {
        return_to::<D>(system, state, equation);
    }
    carry.lambda
}

/// Evaluates rows and forces at the state, and factors A there.
pub(crate) fn return_to<const D: usize>(system: &System, state: &State, equation: &mut Equation) {
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    equation.apply_forces(system, motion);
    equation.constrain(system, motion);
    equation.factor::<D>(system, 0.0);
}
