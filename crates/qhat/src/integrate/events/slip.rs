//! The direction of friction over one substep, in space: whether it follows the slip, and how short a substep that
//! takes.
//!
//! In the plane a slip cannot turn while its mode lasts. In space friction of a contact changes the slip by
//!
//! ```text
//! |Δslip| = h μ |λ_n| w,   w = J_t W J_tᵀ of a tangential row
//! ```
//!
//! in a substep of h. While |slip| is a few times that, the direction of friction follows the slip at every stage.
//! Below that it would turn faster than an explicit step can resolve; it is frozen, which is dissipative.

use crate::constraint::Rows;
use crate::multiplier::{Equation, Sliding};
use crate::point::dot;
use crate::system::System;

/// The direction of friction follows the slip while |slip| > `FAST` × (change of slip by friction in one substep).
const FAST: f64 = 4.0;

/// Angle between the slip and the direction of friction [rad] above which the substep must be short enough to follow.
const ASTRAY: f64 = 0.03;

/// Ċ of every row, active or not, and λ, at the start of a substep.
#[derive(Clone, Debug, Default)]
pub(super) struct AtStart {
    pub(super) Cd: Vec<f64>,
    pub(super) lambda: Vec<f64>,
}

impl AtStart {
    /// Decides for a substep of h which directions follow their slip.
    pub(super) fn prepare<const D: usize>(&self, system: &System, equation: &mut Equation, h: f64) {
        let Equation { sliding, rows, .. } = equation;
        for contact in sliding.iter_mut().filter(|contact| contact.tangents.len() == 2) {
            contact.slip.follows = self.followable::<D>(system, rows, contact).0 > h;
        }
    }

    /// The longest substep from here [s]: bounded where a contact slips faster than the rest speed [m/s] and its slip
    /// has left the direction of friction.
    pub(super) fn longest<const D: usize>(&self, system: &System, equation: &Equation, rest_speed: f64) -> f64 {
        let mut longest = f64::INFINITY;
        for contact in equation.sliding.iter().filter(|contact| contact.tangents.len() == 2) {
            let (h, slip) = self.followable::<D>(system, &equation.rows, contact);
            let d = contact.slip.at_start;
            let across = (slip[0] * d[1] - slip[1] * d[0]).abs();
            let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
            if speed > rest_speed && across > ASTRAY * speed {
                longest = longest.min(0.5 * h);
            }
        }
        longest
    }

    /// The longest substep in which d can follow the slip [s], and the slip at the start of the substep [m/s].
    fn followable<const D: usize>(&self, system: &System, rows: &Rows, contact: &Sliding) -> (f64, [f64; 2]) {
        let (layout, W) = (&rows.J.layout, &system.inverse_mass);
        let row = contact.tangents.start;
        let entries = layout.start[row]..layout.start[row + 1];
        let w: f64 = entries.map(|e| W[layout.particle[e].0] * dot(rows.J.entry::<D>(e), rows.J.entry::<D>(e))).sum();
        let slip = [self.Cd[row], self.Cd[row + 1]];
        let speed = (slip[0] * slip[0] + slip[1] * slip[1]).sqrt();
        (speed / (FAST * contact.friction * self.lambda[contact.normal].abs() * w), slip)
    }
}
