//! Events for the report, from a change of modes.

use crate::modes::{Mode, Modes};
use crate::report::{Event, EventKind};
use crate::structure::Contacts;
use crate::system::System;

/// Adds the events at one time [s]: impacts, each a contact with its closing speed [m/s], then the changes from the
/// modes before to those after.
pub(crate) fn write_events(
    (before, after): (&Modes, &Modes),
    impacts: &[(usize, f64)],
    (system, time): (&System, f64),
    events: &mut Vec<Event>,
) {
    let Contacts { list: contacts, breakables } = &system.contacts;
    let mut note = |constraint: usize, kind: EventKind| {
        events.push(Event { time, constraint: system.constraints[constraint].name.clone(), kind });
    };
    for &(k, speed) in impacts {
        note(contacts[k].constraint, EventKind::Impact { speed });
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
    for (number, breakable) in breakables.iter().enumerate() {
        if after.broken[number] && !before.broken[number] {
            note(breakable.constraint, EventKind::Broke);
        }
    }
}
