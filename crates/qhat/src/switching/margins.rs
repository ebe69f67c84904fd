//! What is watched between events: margins, each in units of its own tolerance, all at least −1 while the modes are right.
//!
//! ```text
//! open       C                          closed     λ_n
//! sticking   μ λ_n − |λ_t|              sliding    slip · direction
//! breakable  limit − |λ|
//! ```

use super::{Mode, Modes};
use crate::multiplier::Equation;
use crate::settings::Settings;
use crate::system::System;

/// Where a force of this part of the largest counts as none.
const NO_FORCE: f64 = 1e-9;

/// What ended a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Trigger {
    /// A margin of the normal row: what is open closes, what is closed opens.
    Normal(usize),
    /// A margin of friction: what sticks slips, what slips sticks.
    Friction(usize),
    /// What breaks, by its place among the breakable.
    Break(usize),
}

impl Trigger {
    /// Of a place in the list of margins: two for each contact, then one for each breakable.
    pub(crate) fn of(margin: usize, contacts: usize) -> Self {
        match margin.checked_sub(2 * contacts) {
            Some(breakable) => Trigger::Break(breakable),
            None if margin.is_multiple_of(2) => Trigger::Normal(margin / 2),
            None => Trigger::Friction(margin / 2),
        }
    }

    /// Whether its margin may be on either side of zero at its event: where something closes or comes to rest.
    pub(crate) fn is_two_sided(self, modes: &Modes) -> bool {
        match self {
            Trigger::Normal(contact) => modes.contacts[contact] == Mode::Open,
            Trigger::Friction(contact) => matches!(modes.contacts[contact], Mode::Sliding(_)),
            Trigger::Break(_) => false,
        }
    }
}

/// The margin that is violated most.
pub(crate) fn first_violated(margins: &[f64]) -> usize {
    (1..margins.len()).fold(0, |most, k| if margins[k] < margins[most] { k } else { most })
}

/// Two margins for each contact and one for each breakable constraint, in units of their tolerances; infinite where there is nothing
/// to watch.
pub(crate) fn write_margins(
    equation: &Equation,
    system: &System,
    settings: &Settings,
    modes: &Modes,
    slow: f64,
    margins: &mut Vec<f64>,
) {
    let lambda = &equation.lambda;
    let least = f64::MIN_POSITIVE;
    let no_force = (NO_FORCE * lambda.iter().fold(0.0_f64, |most, force| most.max(force.abs()))).max(least);
    let no_slip = slow.max(least);
    for (contact, mode) in system.switches.contacts.iter().zip(&modes.contacts) {
        let row = contact.normal;
        margins.extend(match *mode {
            Mode::Open => {
                [equation.gaps.C[row] / (settings.constraint_tolerance * system.row_scale[row]), f64::INFINITY]
            }
            Mode::Smooth => [lambda[row] / no_force, f64::INFINITY],
            Mode::Sticking => {
                let pull: f64 = contact.tangents.clone().map(|row| lambda[row] * lambda[row]).sum();
                [lambda[row] / no_force, (contact.friction * lambda[row] - pull.sqrt()) / no_force]
            }
            Mode::Sliding(direction) => {
                let slip = contact.tangents.clone().zip(direction).map(|(row, d)| equation.gaps.Cd[row] * d);
                [lambda[row] / no_force, slip.sum::<f64>() / no_slip]
            }
        });
    }
    for (breakable, &broken) in system.switches.breakables.iter().zip(&modes.broken) {
        let carried = breakable.rows.clone().map(|row| lambda[row].abs()).fold(0.0, f64::max);
        let margin = (breakable.limit - carried) / (NO_FORCE * breakable.limit);
        margins.push(if broken { f64::INFINITY } else { margin });
    }
}
