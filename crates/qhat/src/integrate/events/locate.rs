//! The time of an event: the length of the substep at which the first event function reaches zero.
//!
//! The length is bracketed, and found by the secant through the ends of the bracket, kept off both (regula falsi).
//! Every length is tried from the start of the substep, so an event is as accurate as the method, whatever its order.
//! An event function that turns negative and back within a substep is seen in the middle, from the cubic through both
//! ends; a quicker one is missed.
//!
//! A force that jumps where a contact slides over an edge, or that grows without bound as friction comes near the
//! point from which it has no answer, brackets a point and no root. The motion then goes on from the near end: the
//! contact is open there for 1e-12 of a frame, and its mode is decided again beyond.

use super::{Attempt, EventStepper, Outcome};
use crate::contact::{EventCause, first_violated};
use crate::linalg::eight::LANES;
use crate::modes::Mode;
use crate::point::Motion;
use crate::state::State;

/// The largest value at the event of an event function that may be on either side of zero there. It costs an attempt
/// more than 1 would, and leaves the time of an impact good to 1e-12 of the extent over the speed.
const SHARP: f64 = 0.01;

/// Attempts at one event. Halving alone narrows a bracket of a frame to `SAME_TIME` in 44; the secant is quicker.
const ATTEMPTS: usize = 60;

/// Length of a bracket, in frames, at which its ends count as the same time.
const SAME_TIME: f64 = 1e-13;

impl<const D: usize> EventStepper<'_, D> {
    /// The length at which the first event function is met, between 0 and `high`, at which some are violated.
    pub(super) fn locate(&mut self, state: &State, mut high: f64) -> Result<(f64, Attempt), Outcome> {
        let mut low = 0.0;
        let mut at_low = self.event_functions_at_start.clone();
        let mut at_high = self.event_functions.clone();
        let mut weight = 1.0;
        let mut was_low = false;
        for _ in 0..ATTEMPTS {
            let first = first_violated(&at_high);
            let cause = EventCause::of(first, self.modes.contacts.len());
            let is_two_sided = cause.is_two_sided(&self.modes);
            // The cause if a force, or its direction, jumps across zero there.
            let jump = match cause {
                EventCause::Normal(k) | EventCause::Friction(k) | EventCause::Turn(k) if !is_two_sided => {
                    Some(EventCause::Singular(k))
                }
                _ => None,
            };
            // The aim is the middle of the allowed values.
            let aim = if is_two_sided { 0.0 } else { 0.5 };
            let (g_low, g_high) = ((at_low[first] + aim).max(0.1 * SHARP), at_high[first] + aim);
            // An end of the bracket that stays for the second time counts half.
            let (g_low, g_high) = if was_low { (g_low, weight * g_high) } else { (weight * g_low, g_high) };
            let middle = if g_low.is_finite() { g_low / (g_low - g_high) } else { 0.5 };
            let h = low + middle.clamp(1e-3, 1.0 - 1e-3) * (high - low);
            let attempt = self.try_length(state, h)?;
            let is_violated = self.event_functions.iter().any(|&function| function < -1.0);
            // A contact that opens or slips, and a constraint that breaks, must be past the point, so that the next
            // substep does not take it back.
            let is_there = !is_violated && self.event_functions[first] <= if is_two_sided { SHARP } else { 0.0 };
            if is_there || high - low < SAME_TIME * self.frame {
                if let Some(jump) = jump.filter(|_| !is_there) {
                    // The motion beyond the jump cannot be kept.
                    let attempt =
                        if low > 0.0 { self.try_length(state, low)? } else { return Err(self.stay(state, jump)) };
                    self.cause = Some(jump);
                    return Ok((low, attempt));
                }
                self.cause = Some(cause);
                return Ok((h, attempt));
            }
            weight = if is_violated != was_low { 0.5 * weight } else { 1.0 };
            was_low = !is_violated;
            if is_violated {
                high = h;
                at_high.clone_from(&self.event_functions);
            } else {
                low = h;
                at_low.clone_from(&self.event_functions);
            }
        }
        Err(Outcome::NotMet)
    }

    /// Whether an open contact is closed in the middle of the substep tried last, by the cubic through its ends.
    pub(super) fn is_missed(&mut self, h: f64, t: f64) -> bool {
        let (system, settings, workspace) = (self.run.system, self.run.settings, &mut *self.run.field.workspace);
        if !self.modes.contacts.contains(&Mode::Open) {
            return false;
        }
        let stages = &*self.run.stages;
        let coordinates = system.coordinate_count();
        let mut middle = vec![0.0; stages.q.len() * LANES];
        for (k, middle) in middle.chunks_exact_mut(LANES).enumerate() {
            for (lane, x) in middle.iter_mut().enumerate() {
                let (q, qd) = (stages.q[k].0[lane], stages.qd[k].0[lane]);
                let (next_q, next_qd) = (stages.next_q[k].0[lane], stages.next_qd[k].0[lane]);
                *x = 0.5 * (q + next_q) + 0.125 * h * (qd - next_qd);
            }
        }
        let (equation, qd) = (&mut workspace.equation, &workspace.qd);
        equation.constrain(system, Motion::<D> { q: &middle[..coordinates], qd, t: t + 0.5 * h });
        let contacts = system.contacts.list.iter().zip(&self.modes.contacts);
        let open = contacts.filter(|&(contact, &mode)| mode == Mode::Open && !self.modes.is_gone(contact));
        let mut rows = open.map(|(contact, _)| contact.normal);
        let is_missed = rows.any(|row| equation.gaps.C[row] < -settings.constraint_tolerance * system.row_scale[row]);
        equation.constrain(system, Motion::<D> { q: &workspace.q, qd, t: t + h });
        is_missed
    }
}
