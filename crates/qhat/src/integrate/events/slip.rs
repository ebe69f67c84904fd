//! The direction of friction over one substep, in space.
//!
//! In the plane a slip cannot turn while its mode lasts. In space friction of a contact changes the slip v by
//!
//! ```text
//! |Δv| = K = h μ |λ_n| w,   w = J_t W J_tᵀ of a tangential row
//! ```
//!
//! in a substep of h. While |v| is a few times K, the direction of friction is d = v/|v| at every stage of the method.
//! A slower slip may turn faster than an explicit method can resolve, or stop on the way. Then d turns, evenly in time,
//! from the direction at the start to that of the slip at the end, as the implicit Euler method has it,
//!
//! ```text
//! d = u/|u|,   u = v' + K d          v': the slip at the end; u: what it would be without this friction
//! ```
//!
//! which is found by trying the substep again. Nothing of v' is then across d, so a slip that stops, stops in both
//! components. The largest part of v that is across d at any stage is the error of such a substep, beside that of the
//! pair, and shrinks with it.
//! Source of the implicit rule: Moreau, Unilateral Contact and Dry Friction in Finite Freedom Dynamics (1988).

use crate::constraint::Rows;
use crate::contact::{along, size};
use crate::modes::{Course, is_same_slip};
use crate::multiplier::{Equation, Sliding};
use crate::point::dot;
use crate::system::System;

/// The direction of friction follows the slip while |v| > `FAST` × K: the slip then turns by no more than a quarter of
/// a radian through friction in one substep, which eight orders of a method resolve.
const FAST: f64 = 4.0;

/// Ċ of every row, active or not, and λ, at the start of a substep.
#[derive(Clone, Debug, Default)]
pub(super) struct AtStart {
    pub(super) Cd: Vec<f64>,
    pub(super) lambda: Vec<f64>,
}

/// The errors of directions that turn in a substep [m/s].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Astray {
    /// The largest part of a slip across d: the error of the substep.
    pub(super) across: f64,
    /// max K |d' − d|, d' the direction that the rule gives after the substep tried with d.
    pub(super) turned: f64,
}

impl AtStart {
    /// Decides for a substep from `start` over h [s] how directions go on; whether there are any that may turn. A slip
    /// slower than `rest_speed` [m/s] at the start has no direction of its own there: d is that at the end all the
    /// time.
    pub(super) fn prepare<const D: usize>(
        &self,
        system: &System,
        equation: &mut Equation,
        (start, h): (f64, f64),
        rest_speed: f64,
    ) -> bool {
        let Equation { sliding, rows, .. } = equation;
        let mut turns = false;
        for contact in sliding.iter_mut().filter(|contact| contact.tangents.len() == 2) {
            turns = true;
            let v = slip(contact, &self.Cd);
            let speed = size(v);
            let K = change::<D>(contact, h, self.lambda[contact.normal], system, rows);
            let along_v = (speed > rest_speed).then(|| v.map(|v| v / speed));
            // The substep before this one may have been tried from the same start.
            let to = match contact.slip.course {
                Course::Turns { to, .. } => to,
                Course::Kept | Course::Follows => along_v.unwrap_or(contact.slip.at_start),
            };
            let from = along_v.unwrap_or(to);
            let turn = Course::Turns { from, to, start, h };
            contact.slip.course = if speed > FAST * K { Course::Follows } else { turn };
            contact.slip.across = 0.0;
        }
        turns
    }

    /// Aims directions that turn at what the rule gives after a substep of h that was tried with them.
    pub(super) fn align<const D: usize>(
        &self,
        system: &System,
        equation: &mut Equation,
        h: f64,
        rest_speed: f64,
    ) -> Astray {
        let Equation { sliding, rows, gaps, lambda, .. } = equation;
        let mut astray = Astray::default();
        for contact in sliding.iter_mut() {
            let Course::Turns { from, to, start, h: _ } = contact.slip.course else { continue };
            let K = change::<D>(contact, h, lambda[contact.normal], system, rows);
            let after = slip(contact, &gaps.Cd);
            let u = [after[0] + K * to[0], after[1] + K * to[1]];
            let free = size(u);
            let is_at_rest = size(slip(contact, &self.Cd)) <= rest_speed;
            let next = if free > 0.0 { u.map(|u| u / free) } else { to };
            let next = if is_at_rest || is_same_slip(from, next) { next } else { from };
            astray.across = astray.across.max(contact.slip.across);
            astray.turned = astray.turned.max(K * size([next[0] - to[0], next[1] - to[1]]));
            let from = if is_at_rest { next } else { from };
            contact.slip.course = Course::Turns { from, to: next, start, h };
            contact.slip.across = 0.0;
        }
        astray
    }
}

/// The slip of a contact [m/s].
fn slip(contact: &Sliding, Cd: &[f64]) -> [f64; 2] {
    along(contact.tangents.clone().map(|row| Cd[row]))
}

/// K [m/s].
fn change<const D: usize>(contact: &Sliding, h: f64, lambda_n: f64, system: &System, rows: &Rows) -> f64 {
    let (layout, W) = (&rows.J.layout, &system.inverse_mass);
    let row = contact.tangents.start;
    let entries = layout.start[row]..layout.start[row + 1];
    let w: f64 = entries.map(|e| W[layout.particle[e].0] * dot(rows.J.entry::<D>(e), rows.J.entry::<D>(e))).sum();
    h * contact.friction * lambda_n.abs() * w
}
