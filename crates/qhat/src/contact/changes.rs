//! The report of a resolution: changes of modes as events, and contacts that were struck at once.

use super::EventResolution;
use crate::modes::{Mode, Modes};
use crate::report::{Event, EventKind, Warning};
use crate::structure::Contacts;

impl<const D: usize> EventResolution<'_, D> {
    /// Two contacts that give back speed and share a particle that moves, both with an impulse.
    pub(super) fn shared(&self, near: &[usize]) -> Option<Warning> {
        let (list, layout) = (&self.system.contacts.list, &self.equation.rows.J.layout);
        let struck: Vec<usize> = near
            .iter()
            .copied()
            .filter(|&k| list[k].restitution > 0.0 && self.equation.lambda[list[k].normal] > 0.0)
            .collect();
        let moving = |k: usize| {
            let particles = &layout.particle[layout.start[list[k].normal]..layout.start[list[k].normal + 1]];
            particles.iter().filter(|particle| self.system.inverse_mass[particle.0] > 0.0)
        };
        let pair = struck.iter().enumerate().find_map(|(place, &one)| {
            let other =
                struck[place + 1..].iter().find(|&&other| moving(one).any(|a| moving(other).any(|b| a == b)))?;
            Some([one, *other])
        })?;
        let name = |k: usize| self.system.constraints[list[k].constraint].name.clone();
        Some(Warning::SharedImpact { time: self.t, constraints: pair.map(name) })
    }

    /// Adds the changes from the modes before to those after.
    pub(super) fn write_changes(&self, before: &Modes, after: &Modes, events: &mut Vec<Event>) {
        let Contacts { list: contacts, breakables } = &self.system.contacts;
        for (k, contact) in contacts.iter().enumerate() {
            let kind = match (before.contacts[k], after.contacts[k]) {
                (Mode::Open, Mode::Open) => continue,
                (Mode::Open, _) => EventKind::Closed,
                (_, Mode::Open) => EventKind::Opened,
                (Mode::Sticking, Mode::Sliding(_)) => EventKind::Slipped,
                (Mode::Sliding(_), Mode::Sticking) => EventKind::Stuck,
                _ => continue,
            };
            events.push(self.event(contact.constraint, kind));
        }
        for (number, breakable) in breakables.iter().enumerate() {
            let is_told = || {
                let name = &self.system.constraints[breakable.constraint].name;
                events.iter().any(|event| event.kind == EventKind::Broke && event.constraint == *name)
            };
            if after.broken[number] && !before.broken[number] && !is_told() {
                events.push(self.event(breakable.constraint, EventKind::Broke));
            }
        }
    }

    pub(super) fn event(&self, constraint: usize, kind: EventKind) -> Event {
        Event { time: self.t, constraint: self.system.constraints[constraint].name.clone(), kind, impulse: 0.0 }
    }
}
