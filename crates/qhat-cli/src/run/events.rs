//! What happened to contacts and to what breaks, counted.

use crate::print::count;
use qhat::{Event, EventKind};
use serde::Serialize;

/// How many events of each kind a run had, and what broke.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(super) struct Events {
    impacts: usize,
    closed: usize,
    opened: usize,
    slipped: usize,
    stuck: usize,
    broke: Vec<Break>,
}

/// What broke, and when \[s\].
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

    /// For a person: the counts in one line, what broke in one each; nothing where nothing happened.
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
