//! Constraints that act only while they must: contacts that open and close, and what breaks.
//!
//! A contact holds C ≥ 0 with λ ≥ 0, one of the two zero; with friction it has one row for each direction along the surface. The
//! rows are always there, and evaluated; which of them take part in A λ = b is its mode:
//!
//! ```text
//! open       none                 λ = 0, C ≥ 0
//! smooth     normal               C = 0, λ ≥ 0, no friction
//! sticking   normal, tangents     no slip, |λ_t| ≤ μ λ_n
//! sliding    normal               λ_t = −μ λ_n (direction of slip), an applied force that follows λ_n
//! ```
//!
//! Between two events no mode changes, and the motion is as smooth as with equations alone. `integrate/events/` finds the time of
//! each event, `impact.rs` the jump of the velocity, `complementarity.rs` the modes that go on.
//! Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts (1996).

mod complementarity;
mod cones;
mod impact;
mod lemke;
mod margins;
mod modes;
mod reaction;
mod start;

pub(crate) use complementarity::Jam;
use complementarity::{Touching, settle};
use impact::{collide, hold, shock};
pub(crate) use margins::{Normals, Trigger, first_violated, write_margins};
pub(crate) use modes::{Mode, Modes};
pub(crate) use reaction::{Moment, Pace, TOUCHES, still};
pub(crate) use start::{close, deepest};

#[cfg(test)]
mod tests;

use crate::constraint::Holds;
use crate::system::NamedConstraint;
use std::ops::Range;

/// The cosine above which two directions of slip are one: 0.03 rad.
const SAME_WAY: f64 = 0.9995;

/// A row that opens and closes, with its rows of friction.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contact {
    /// Its place among the constraints.
    pub(crate) constraint: usize,
    pub(crate) normal: usize,
    /// None without friction; one in the plane, two in space.
    pub(crate) tangents: Range<usize>,
    /// e, the part of the closing speed that an impact gives back.
    pub(crate) restitution: f64,
    /// μ.
    pub(crate) friction: f64,
    /// Its place among what breaks.
    pub(crate) breakable: Option<usize>,
}

/// A constraint that breaks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Breakable {
    /// Its place among the constraints.
    pub(crate) constraint: usize,
    pub(crate) rows: Range<usize>,
    /// The tension that it does not survive [N].
    pub(crate) limit: f64,
}

/// Everything of a system that switches.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Switches {
    pub(crate) contacts: Vec<Contact>,
    pub(crate) breakables: Vec<Breakable>,
}

impl Switches {
    pub(crate) fn new(constraints: &[NamedConstraint], dimension: usize) -> Self {
        let mut switches = Switches::default();
        for (place, NamedConstraint { constraint, first_row, .. }) in constraints.iter().enumerate() {
            let breakable = constraint.breaks_at().map(|_| switches.breakables.len());
            for rows in constraint.contacts(dimension) {
                let normal = first_row + rows.normal;
                let tangents = first_row + rows.tangents.start..first_row + rows.tangents.end;
                let (restitution, friction) = (rows.restitution, rows.friction);
                switches.contacts.push(Contact {
                    constraint: place,
                    normal,
                    tangents,
                    restitution,
                    friction,
                    breakable,
                });
            }
            if let Some(limit) = constraint.breaks_at() {
                let rows = *first_row..first_row + constraint.row_count(dimension);
                switches.breakables.push(Breakable { constraint: place, rows, limit });
            }
        }
        switches
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.contacts.is_empty() && self.breakables.is_empty()
    }
}
