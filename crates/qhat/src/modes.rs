//! The mode of every contact, and which breakable constraints are broken.

use crate::structure::{Contact, Contacts};

/// The mode of a contact: its active rows, and the way in which its friction acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode {
    /// Apart: no row is active.
    Open,
    /// Closed, without friction: the normal row is active.
    Smooth,
    /// Closed, without slip: the normal row and the tangential rows are active.
    Sticking,
    /// Closed, with slip: the normal row is active, and friction is an applied force against the slip.
    Sliding(Slip),
}

impl Mode {
    /// A contact that slips in a direction, a unit vector in its tangential rows.
    pub(crate) fn sliding(direction: [f64; 2]) -> Self {
        Mode::Sliding(Slip::along(direction))
    }

    pub(crate) fn is_closed(self) -> bool {
        self != Mode::Open
    }
}

/// The slip of a sliding contact, in its tangential rows; the second component is zero in the plane.
///
/// In [`Modes`] the direction is that at the start of the next substep. Within a substep it may follow the slip; then
/// `at_start` and `follows` say from where and whether.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slip {
    /// d, a unit vector. Friction acts along −d.
    pub(crate) direction: [f64; 2],
    /// d at the start of the substep.
    pub(crate) at_start: [f64; 2],
    /// Whether d is updated from the slip within the substep; `integrate/events/slip.rs` decides it.
    pub(crate) follows: bool,
}

/// Slips are equal if their directions are: the other two fields matter only within a substep.
impl PartialEq for Slip {
    fn eq(&self, other: &Self) -> bool {
        self.direction == other.direction
    }
}

impl Slip {
    /// A slip in a direction that it keeps until told otherwise.
    pub(crate) fn along(direction: [f64; 2]) -> Self {
        Slip { direction, at_start: direction, follows: false }
    }

    /// Updates d from the slip velocity [m/s], if d follows it.
    pub(crate) fn follow(&mut self, velocity: [f64; 2]) {
        if self.follows {
            let speed = (velocity[0] * velocity[0] + velocity[1] * velocity[1]).sqrt();
            let along = velocity[0] * self.at_start[0] + velocity[1] * self.at_start[1];
            // A slip more than 60° away from its start has stopped on the way: the event is found with the old
            // direction.
            let is_same_slip = speed > 0.0 && along > 0.5 * speed;
            self.direction = if is_same_slip { velocity.map(|component| component / speed) } else { self.at_start };
        }
    }

    /// Starts the next substep in the direction that d has reached.
    pub(crate) fn start(&mut self) {
        *self = Slip::along(self.direction);
    }
}

/// The modes of all contacts, and which breakable constraints are broken.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Modes {
    pub(crate) contacts: Vec<Mode>,
    pub(crate) broken: Vec<bool>,
}

impl Modes {
    /// All contacts open, no constraint broken.
    pub(crate) fn at_first(contacts: &Contacts) -> Self {
        Modes { contacts: vec![Mode::Open; contacts.list.len()], broken: vec![false; contacts.breakables.len()] }
    }

    /// Whether a contact is broken.
    pub(crate) fn is_gone(&self, contact: &Contact) -> bool {
        contact.breakable.and_then(|breakable| self.broken.get(breakable)).is_some_and(|&broken| broken)
    }

    /// Writes for each row whether it is inactive (off): λ = 0 there, and the row is no part of A λ = b.
    pub(crate) fn write_inactive(&self, contacts: &Contacts, inactive: &mut [bool]) {
        inactive.fill(false);
        for (Contact { normal, tangents, .. }, mode) in contacts.list.iter().zip(&self.contacts) {
            inactive[*normal] = *mode == Mode::Open;
            inactive[tangents.clone()].fill(*mode != Mode::Sticking);
        }
        for (breakable, &broken) in contacts.breakables.iter().zip(&self.broken) {
            if broken {
                inactive[breakable.rows.clone()].fill(true);
            }
        }
    }
}
