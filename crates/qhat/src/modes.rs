//! What every contact is doing, and what is broken.

use crate::structure::{Contact, Contacts};

/// What a contact is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode {
    /// It does not act.
    Open,
    /// It holds, and has no friction.
    Smooth,
    /// It holds, and does not slip.
    Sticking,
    /// It holds, and slips in this direction: a unit vector in its tangential rows.
    Sliding([f64; 2]),
}

impl Mode {
    pub(crate) fn is_closed(self) -> bool {
        self != Mode::Open
    }
}

/// The modes of all contacts, and which breakable constraints are broken.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Modes {
    pub(crate) contacts: Vec<Mode>,
    pub(crate) broken: Vec<bool>,
}

impl Modes {
    /// All open, nothing broken.
    pub(crate) fn at_first(contacts: &Contacts) -> Self {
        Modes { contacts: vec![Mode::Open; contacts.list.len()], broken: vec![false; contacts.breakables.len()] }
    }

    /// Whether a contact is broken.
    pub(crate) fn is_gone(&self, contact: &Contact) -> bool {
        contact.breakable.and_then(|breakable| self.broken.get(breakable)).is_some_and(|&broken| broken)
    }

    /// Says for each row whether it takes no part.
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
