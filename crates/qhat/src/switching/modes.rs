//! What every contact is doing, and what is broken.

use super::{Contact, Switches};

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
    pub(crate) fn at_first(switches: &Switches) -> Self {
        Modes { contacts: vec![Mode::Open; switches.contacts.len()], broken: vec![false; switches.breakables.len()] }
    }

    /// Says for each row whether it takes no part.
    pub(crate) fn write_off(&self, switches: &Switches, off: &mut [bool]) {
        off.fill(false);
        for (Contact { normal, tangents, .. }, mode) in switches.contacts.iter().zip(&self.contacts) {
            off[*normal] = *mode == Mode::Open;
            off[tangents.clone()].fill(*mode != Mode::Sticking);
        }
        for (breakable, &broken) in switches.breakables.iter().zip(&self.broken) {
            if broken {
                off[breakable.rows.clone()].fill(true);
            }
        }
    }
}
