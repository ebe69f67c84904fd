//! What every contact is doing, and what is broken.

use super::{Contact, Switches};
use crate::report::{Event, EventKind};
use crate::system::System;

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

    /// Whether a contact is broken.
    pub(crate) fn is_gone(&self, contact: &Contact) -> bool {
        contact.breakable.and_then(|breakable| self.broken.get(breakable)).is_some_and(|&broken| broken)
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

    /// Adds what happened between the modes before and these: impacts, each a contact with its speed [m/s], then what changed.
    pub(crate) fn write_events(
        &self,
        before: &Modes,
        impacts: &[(usize, f64)],
        (system, time): (&System, f64),
        events: &mut Vec<Event>,
    ) {
        let Switches { contacts, breakables, .. } = &system.switches;
        let mut note = |place: usize, kind: EventKind| {
            events.push(Event { time, constraint: system.constraints[place].name.clone(), kind });
        };
        for &(contact, speed) in impacts {
            note(contacts[contact].constraint, EventKind::Impact { speed });
        }
        for (k, contact) in contacts.iter().enumerate() {
            let kind = match (before.contacts[k], self.contacts[k]) {
                (Mode::Open, Mode::Open) => continue,
                (Mode::Open, _) => EventKind::Closed,
                (_, Mode::Open) => EventKind::Opened,
                (Mode::Sticking, Mode::Sliding(_)) => EventKind::Slipped,
                (Mode::Sliding(_), Mode::Sticking) => EventKind::Stuck,
                _ => continue,
            };
            note(contact.constraint, kind);
        }
        for (k, breakable) in breakables.iter().enumerate() {
            if self.broken[k] && !before.broken[k] {
                note(breakable.constraint, EventKind::Broke);
            }
        }
    }
}
