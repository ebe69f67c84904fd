//! The mode of every contact, and which breakable constraints are broken.

use crate::structure::{Contact, Contacts};

/// The mode of a contact: its active rows, and the way in which its friction acts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
/// In [`Modes`] the direction is that at the start of the next substep; within a substep `course` says how it goes on.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Slip {
    /// d, a unit vector. Friction acts along −d.
    pub(crate) direction: [f64; 2],
    /// d at the start of the substep.
    pub(crate) at_start: [f64; 2],
    /// d within the substep; `integrate/events/slip.rs` decides it.
    pub(crate) course: Course,
    /// The largest part of the slip across d within a substep in which d turns [m/s].
    pub(crate) across: f64,
}

/// The direction of friction within a substep.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Course {
    /// The same all the time.
    Kept,
    /// That of the slip at every stage.
    Follows,
    /// It turns from one direction at `start` \[s\] to another at `start + h`.
    Turns { from: [f64; 2], to: [f64; 2], start: f64, h: f64 },
}

/// Slips are equal if their directions are: the other fields matter only within a substep.
impl PartialEq for Slip {
    fn eq(&self, other: &Self) -> bool {
        self.direction == other.direction
    }
}

/// A vector of length 1, `None` of a zero.
fn unit(v: [f64; 2]) -> Option<[f64; 2]> {
    let size = (v[0] * v[0] + v[1] * v[1]).sqrt();
    (size > 0.0).then(|| v.map(|component| component / size))
}

/// Whether a slip may have turned from one direction to another in one substep. A slip more than 60° away from its
/// start has stopped on the way; the event is found with the old direction.
pub(crate) fn is_same_slip(from: [f64; 2], to: [f64; 2]) -> bool {
    from[0] * to[0] + from[1] * to[1] > 0.5
}

impl Slip {
    /// A slip in a direction that it keeps until told otherwise.
    pub(crate) fn along(direction: [f64; 2]) -> Self {
        Slip { direction, at_start: direction, course: Course::Kept, across: 0.0 }
    }

    /// Updates d at a stage at the time t [s] with the slip velocity v [m/s].
    pub(crate) fn go_on(&mut self, v: [f64; 2], t: f64) {
        match self.course {
            Course::Kept => {}
            Course::Follows => {
                self.direction = unit(v).filter(|&d| is_same_slip(self.at_start, d)).unwrap_or(self.at_start);
            }
            Course::Turns { from, to, start, h } => {
                let part = ((t - start) / h).clamp(0.0, 1.0);
                let between = [0, 1].map(|k| (1.0 - part) * from[k] + part * to[k]);
                self.direction = unit(between).unwrap_or(to);
                let across = v[0] * self.direction[1] - v[1] * self.direction[0];
                self.across = self.across.max(across.abs());
            }
        }
    }

    /// Starts the next substep in the direction that d has reached.
    pub(crate) fn start(&mut self) {
        *self = Slip::along(self.direction);
    }
}

/// The modes of all contacts, and which breakable constraints are broken.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
