//! What is watched between events: event_functions, each in units of its own tolerance, all at least −1 while the modes are right.
//!
//! ```text
//! open       C                          closed     λ_n
//! sticking   μ λ_n − |λ_t|              sliding    slip · direction
//! breakable  limit − |λ|                any closed one: by how much its normal has turned since the substep began
//! ```
//!
//! A normal turns at once where a contact slides over an edge; projected onto C = 0 beyond it, the motion would be bent round the edge.

use crate::constraint::Rows;
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::point::{Point, dot};
use crate::settings::Settings;
use crate::system::System;

/// Where a force of this part of the largest counts as none.
const NO_FORCE: f64 = 1e-9;

/// What ended a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EventCause {
    /// A margin of the normal row: what is open closes, what is closed opens.
    Normal(usize),
    /// A margin of friction: what sticks slips, what slips sticks.
    Friction(usize),
    /// The normal has turned far, or the directions in which slip is counted.
    Turn(usize),
    /// What breaks, by its place among the breakable.
    Break(usize),
    /// No margin: the force of a contact has no answer, or jumps where there is an edge. It is let go for a moment.
    Singular(usize),
}

impl EventCause {
    /// Of a place in the list of event_functions: three for each contact, then one for each breakable.
    pub(crate) fn of(margin: usize, contacts: usize) -> Self {
        match (margin.checked_sub(3 * contacts), margin % 3) {
            (Some(breakable), _) => EventCause::Break(breakable),
            (None, 0) => EventCause::Normal(margin / 3),
            (None, 1) => EventCause::Friction(margin / 3),
            (None, _) => EventCause::Turn(margin / 3),
        }
    }

    /// Whether its margin may be on either side of zero at its event: where something closes or comes to rest.
    pub(crate) fn is_two_sided(self, modes: &Modes) -> bool {
        match self {
            EventCause::Normal(contact) => modes.contacts[contact] == Mode::Open,
            EventCause::Friction(contact) => matches!(modes.contacts[contact], Mode::Sliding(_)),
            EventCause::Turn(_) | EventCause::Break(_) | EventCause::Singular(_) => false,
        }
    }
}

/// The margin that is violated most.
pub(crate) fn first_violated(event_functions: &[f64]) -> usize {
    (1..event_functions.len()).fold(0, |most, k| if event_functions[k] < event_functions[most] { k } else { most })
}

/// The cosine to which a normal may turn in a substep, 60°, and what counts as one of it. What turns so far without an edge only ends a
/// substep there.
const TURNED: f64 = 0.5;
const FAR: f64 = 0.1;

/// Three margins for each contact and one for each breakable constraint, in units of their tolerances; infinite where there is nothing
/// to watch.
pub(crate) fn write_event_functions<const D: usize>(
    equation: &Equation,
    system: &System,
    settings: &Settings,
    modes: &Modes,
    (rest_speed, normals): (f64, &Normals),
    event_functions: &mut Vec<f64>,
) {
    let lambda = &equation.lambda;
    let least = f64::MIN_POSITIVE;
    let no_force = (NO_FORCE * lambda.iter().fold(0.0_f64, |most, force| most.max(force.abs()))).max(least);
    let no_slip = rest_speed.max(least);
    for (contact, mode) in system.contacts.list.iter().zip(&modes.contacts) {
        let row = contact.normal;
        let friction = match *mode {
            Mode::Open if modes.is_gone(contact) => {
                event_functions.extend([f64::INFINITY; 3]);
                continue;
            }
            Mode::Open => {
                let gap = equation.gaps.C[row] / (settings.constraint_tolerance * system.row_scale[row]);
                event_functions.extend([gap, f64::INFINITY, f64::INFINITY]);
                continue;
            }
            Mode::Smooth => f64::INFINITY,
            Mode::Sticking => {
                let pull: f64 = contact.tangents.clone().map(|row| lambda[row] * lambda[row]).sum();
                (contact.friction * lambda[row] - pull.sqrt()) / no_force
            }
            Mode::Sliding(direction) => {
                let slip = contact.tangents.clone().zip(direction).map(|(row, d)| equation.gaps.Cd[row] * d);
                slip.sum::<f64>() / no_slip
            }
        };
        let rows = std::iter::once(row).chain(contact.tangents.clone());
        let turned = rows.map(|row| normals.cosine::<D>(&equation.rows, row)).fold(1.0, f64::min);
        event_functions.extend([lambda[row] / no_force, friction, (turned - TURNED) / FAR]);
    }
    for (breakable, &broken) in system.contacts.breakables.iter().zip(&modes.broken) {
        let carried = breakable.rows.clone().map(|row| lambda[row].abs()).fold(0.0, f64::max);
        let margin = (breakable.limit - carried) / (NO_FORCE * breakable.limit);
        event_functions.push(if broken { f64::INFINITY } else { margin });
    }
}

/// J where a substep began.
#[derive(Clone, Debug, Default)]
pub(crate) struct Normals {
    /// d numbers for each entry of J.
    entries: Vec<f64>,
}

impl Normals {
    pub(crate) fn begin<const D: usize>(&mut self, rows: &Rows) {
        self.entries.clear();
        (0..rows.J.layout.particle.len()).for_each(|e| self.entries.extend(rows.J.entry::<D>(e)));
    }

    /// The cosine between a row of J then and now.
    fn cosine<const D: usize>(&self, rows: &Rows, row: usize) -> f64 {
        let entries = rows.J.layout.start[row]..rows.J.layout.start[row + 1];
        let [mut along, mut then, mut now] = [0.0; 3];
        for e in entries {
            let (a, b): (Point<D>, Point<D>) = (std::array::from_fn(|k| self.entries[e * D + k]), rows.J.entry::<D>(e));
            along += dot(a, b);
            then += dot(a, a);
            now += dot(b, b);
        }
        along / (then * now).sqrt()
    }
}
