//! What a change of modes is to a user: events.

use crate::modes::{Mode, Modes};
use crate::report::{Event, EventKind};
use crate::structure::Contacts;
use crate::system::System;

/// Adds what happened between the modes before and these: impacts, each a contact with its speed [m/s], then what changed.
pub(crate) fn write_events(
    (before, after): (&Modes, &Modes),
    impacts: &[(usize, f64)],
    (system, time): (&System, f64),
    events: &mut Vec<Event>,
) {
    let Contacts { list: contacts, breakables } = &system.contacts;
    let mut note = |place: usize, kind: EventKind| {
        events.push(Event { time, constraint: system.constraints[place].name.clone(), kind });
    };
    for &(contact, speed) in impacts {
        note(contacts[contact].constraint, EventKind::Impact { speed });
    }
    for (k, contact) in contacts.iter().enumerate() {
        let kind = match (before.contacts[k], after.contacts[k]) {
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
        if after.broken[k] && !before.broken[k] {
            note(breakable.constraint, EventKind::Broke);
        }
    }
}
