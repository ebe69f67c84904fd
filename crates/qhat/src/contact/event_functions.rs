//! The event functions: three for each contact and one for each breakable constraint.
//!
//! Each is in units of its own tolerance, and at least −1 while the modes are right:
//!
//! ```text
//! open       C                          closed     λ_n
//! sticking   μ λ_n − |λ_t|              sliding    slip · direction
//! breakable  limit − |λ|                closed, turn of the normal since the substep began:  cos(turn) − cos 60°
//! ```
//!
//! A normal turns at once where a contact slides over an edge. Projected onto C = 0 beyond the edge, the motion would
//! be bent round it; so such a turn ends the substep.

use crate::constraint::Rows;
use crate::linalg::block::vector;
use crate::modes::{Mode, Modes};
use crate::multiplier::Equation;
use crate::point::{dot, larger, largest};
use crate::settings::Settings;
use crate::system::System;

/// Part of the largest force below which a force counts as zero.
const NO_FORCE: f64 = 1e-9;

/// Cosine to which a normal may turn in one substep: 60°. A curved surface without an edge that turns so far only
/// ends a substep there.
const TURNED: f64 = 0.5;

/// The unit of that event function.
const FAR: f64 = 0.1;

/// The event that ends a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EventCause {
    /// The event function of the normal row reached zero: an open contact closes or a closed contact opens.
    Normal(usize),
    /// The event function of friction reached zero: a sticking contact slips or a sliding contact sticks.
    Friction(usize),
    /// The normal has turned far, or the tangential directions have.
    Turn(usize),
    /// A breakable constraint breaks, by its index among the breakables.
    Break(usize),
    /// The force of a contact has no answer, or jumps at an edge; no event function tells. The contact is open for
    /// one short substep.
    Singular(usize),
}

impl EventCause {
    /// The cause that belongs to an index into the event functions.
    pub(crate) fn of(index: usize, contacts: usize) -> Self {
        match (index.checked_sub(3 * contacts), index % 3) {
            (Some(breakable), _) => EventCause::Break(breakable),
            (None, 0) => EventCause::Normal(index / 3),
            (None, 1) => EventCause::Friction(index / 3),
            (None, _) => EventCause::Turn(index / 3),
        }
    }

    /// Whether the event function may be on either side of zero at the event: where a contact closes or comes to rest.
    pub(crate) fn is_two_sided(self, modes: &Modes) -> bool {
        match self {
            EventCause::Normal(k) => modes.contacts[k] == Mode::Open,
            EventCause::Friction(k) => matches!(modes.contacts[k], Mode::Sliding(_)),
            EventCause::Turn(_) | EventCause::Break(_) | EventCause::Singular(_) => false,
        }
    }
}

/// The index of the event function that is violated most.
pub(crate) fn first_violated(event_functions: &[f64]) -> usize {
    (1..event_functions.len()).fold(0, |most, k| if event_functions[k] < event_functions[most] { k } else { most })
}

/// The data, beside an equation solved at a motion, that event functions depend on.
pub(crate) struct EventFunctions<'a> {
    pub(crate) system: &'a System,
    pub(crate) settings: &'a Settings,
    pub(crate) modes: &'a Modes,
    /// The unit of slip [m/s].
    pub(crate) rest_speed: f64,
    /// J at the start of the substep.
    pub(crate) normals: &'a Normals,
}

impl EventFunctions<'_> {
    /// Writes three for each contact, for λ as `complementarity.rs` decides modes by it; infinite where nothing can
    /// happen.
    pub(crate) fn write<const D: usize>(&self, equation: &Equation, event_functions: &mut Vec<f64>) {
        let EventFunctions { system, settings, modes, rest_speed, normals } = *self;
        event_functions.clear();
        let lambda = &equation.lambda;
        let least = f64::MIN_POSITIVE;
        let no_force = (NO_FORCE * largest(lambda)).max(least);
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
                    let squares: f64 = contact.tangents.clone().map(|row| lambda[row] * lambda[row]).sum();
                    (contact.friction * lambda[row] - squares.sqrt()) / no_force
                }
                Mode::Sliding(slip) => {
                    let along = contact.tangents.clone().zip(slip.direction).map(|(row, d)| equation.gaps.Cd[row] * d);
                    along.sum::<f64>() / no_slip
                }
            };
            let rows = std::iter::once(row).chain(contact.tangents.clone());
            let turned = rows.map(|row| normals.cosine::<D>(&equation.rows, row)).fold(1.0, f64::min);
            event_functions.extend([lambda[row] / no_force, friction, (turned - TURNED) / FAR]);
        }
    }

    /// Adds one for each breakable, for λ that redundant rows share.
    pub(crate) fn add_breakables(&self, lambda: &[f64], event_functions: &mut Vec<f64>) {
        let EventFunctions { system, modes, .. } = *self;
        for (breakable, &broken) in system.contacts.breakables.iter().zip(&modes.broken) {
            let carried = breakable.rows.clone().map(|row| lambda[row].abs()).fold(0.0, larger);
            let reserve = (breakable.limit - carried) / (NO_FORCE * breakable.limit);
            // A tension without a meaning breaks nothing.
            let is_meant = !system.is_second_order(breakable.constraint);
            let cannot_break = broken || !is_meant || breakable.limit.is_infinite();
            event_functions.push(if cannot_break { f64::INFINITY } else { reserve });
        }
    }
}

/// J at the start of a substep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Normals {
    /// d numbers for each entry of J.
    blocks: Vec<f64>,
}

impl Normals {
    pub(crate) fn begin(&mut self, rows: &Rows) {
        self.blocks.clone_from(&rows.J.blocks);
    }

    /// The cosine between a row of J then and now.
    fn cosine<const D: usize>(&self, rows: &Rows, row: usize) -> f64 {
        let entries = rows.J.layout.start[row]..rows.J.layout.start[row + 1];
        let [mut along, mut then, mut now] = [0.0; 3];
        for e in entries {
            let (a, b) = (vector::<D>(&self.blocks, e), rows.J.entry::<D>(e));
            along += dot(a, b);
            then += dot(a, a);
            now += dot(b, b);
        }
        along / (then * now).sqrt()
    }
}
