//! The events of a run: counts of contact events, and the constraints that broke.

use crate::print::count;
use qhat::{Event, EventKind};
use serde::Serialize;

/// The number of contact events of each kind, and the constraints that broke.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(super) struct Events {
    impacts: usize,
    closed: usize,
    opened: usize,
    slipped: usize,
    stuck: usize,
    broke: Vec<Break>,
}

/// A constraint that broke, and the time \[s\].
#[derive(Debug, PartialEq, Serialize)]
struct Break {
    constraint: String,
    time: f64,
}

impl Events {
    pub(super) fn note(&mut self, event: &Event) {
        match event.kind {
            EventKind::Impact { .. } => self.impacts += 1,
            EventKind::Closed => self.closed += 1,
            EventKind::Opened => self.opened += 1,
            EventKind::Slipped => self.slipped += 1,
            EventKind::Stuck => self.stuck += 1,
            EventKind::Broke => self.broke.push(Break { constraint: event.constraint.clone(), time: event.time }),
            // Kinds of a later engine are counted when they have a word here.
            _ => {}
        }
    }

    /// The lines of the summary: the counts in one, each constraint that broke in one; none without events.
    pub(super) fn lines(&self) -> Vec<String> {
        let mut counts = Vec::new();
        if self.impacts > 0 {
            counts.push(count(self.impacts, "impact"));
        }
        for (number, what) in
            [(self.closed, "closed"), (self.opened, "opened"), (self.slipped, "slipped"), (self.stuck, "stuck")]
        {
            if number > 0 {
                counts.push(format!("{number} {what}"));
            }
        }
        let counts = (!counts.is_empty()).then(|| counts.join(", "));
        let broke =
            self.broke.iter().map(|Break { constraint, time }| format!("{constraint} broke at t = {time:.6} s"));
        counts.into_iter().chain(broke).collect()
    }
}
