//! The events of a run: counts of contact events, and the constraints that broke.

use crate::print::count;
use qhat::{Event, EventKind};
use serde::{Deserialize, Serialize};

/// The number of contact events of each kind, and the constraints that broke.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Events {
    impacts: usize,
    closed: usize,
    opened: usize,
    slipped: usize,
    stuck: usize,
    broke: Vec<Blow>,
    /// The impact with the largest impulse.
    largest_impulse: Option<Blow>,
}

/// An impact, or a constraint that broke: the constraint, the time \[s\] and the impulse \[N·s\], which is 0 where a
/// tension broke the constraint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Blow {
    constraint: String,
    time: f64,
    impulse: f64,
}

impl Blow {
    fn of(event: &Event) -> Self {
        let Event { constraint, time, impulse, .. } = event.clone();
        Blow { constraint, time, impulse }
    }
}

impl Events {
    pub(super) fn note(&mut self, event: &Event) {
        match event.kind {
            EventKind::Impact { .. } => {
                self.impacts += 1;
                if self.largest_impulse.as_ref().is_none_or(|former| former.impulse < event.impulse) {
                    self.largest_impulse = Some(Blow::of(event));
                }
            }
            EventKind::Closed => self.closed += 1,
            EventKind::Opened => self.opened += 1,
            EventKind::Slipped => self.slipped += 1,
            EventKind::Stuck => self.stuck += 1,
            EventKind::Broke => self.broke.push(Blow::of(event)),
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
        let broke = self.broke.iter().map(|Blow { constraint, time, impulse }| {
            let cause = if *impulse > 0.0 { format!(", by an impulse of {impulse:.4} N·s") } else { String::new() };
            format!("{constraint} broke at t = {time:.6} s{cause}")
        });
        let largest = self.largest_impulse.iter().map(|Blow { constraint, time, impulse }| {
            format!("the largest impulse: {impulse:.4} N·s in {constraint} at t = {time:.6} s")
        });
        counts.into_iter().chain(largest).chain(broke).collect()
    }
}
