//! Blows: the impact of contacts that close, and the links that it breaks.

use super::resolution::{EventResolution, Resolved};
use super::{Impact, NoConsistentModes, Touching};
use crate::force::Acts;
use crate::modes::Modes;
use crate::point::{Motion, larger};
use crate::report::{Event, EventKind};

impl<const D: usize> EventResolution<'_, D> {
    /// The impact of the closing contacts on all that are near. A link whose impulse is above its strength breaks, and
    /// the impact is taken without it: the one of them that is farthest above it, then the next.
    pub(super) fn collide(
        &mut self,
        modes: &mut Modes,
        near: &[usize],
        closing: &[usize],
        resolved: &mut Resolved,
    ) -> Result<(), NoConsistentModes> {
        let before = self.qd.to_vec();
        loop {
            let is_whole = |k: &&usize| !modes.is_gone(&self.system.contacts.list[**k]);
            let [near, closing] = [near, closing].map(|list| list.iter().filter(is_whole).copied().collect::<Vec<_>>());
            if closing.is_empty() {
                return Ok(());
            }
            let (events, warnings) = (resolved.events.len(), resolved.warnings.len());
            let lost = self.collide_once(modes, &near, &closing, resolved)?;
            let Some((breakable, impulse)) = self.broken_by_impulse(modes) else {
                resolved.lost += lost;
                return Ok(());
            };
            resolved.events.truncate(events);
            resolved.warnings.truncate(warnings);
            let constraint = self.system.contacts.breakables[breakable].constraint;
            resolved.events.push(Event { impulse, ..self.event(constraint, EventKind::Broke) });
            self.break_link(modes, breakable);
            self.qd.copy_from_slice(&before);
            self.evaluate();
        }
    }

    /// Breaks a link. Returns the energy that an elastic one held [J], which leaves with it.
    pub(super) fn break_link(&mut self, modes: &mut Modes, breakable: usize) -> f64 {
        modes.broken[breakable] = true;
        // The force of an elastic link is part of Q, which is evaluated before the modes are settled.
        self.equation.set_modes(self.system, modes);
        let motion = Motion::<D> { q: self.q, qd: self.qd, t: self.t };
        self.system.breakable_force(breakable).map_or(0.0, |force| force.potential(motion, &self.system.mass))
    }

    /// The link whose impulse is farthest above its strength, with the impulse [N·s].
    fn broken_by_impulse(&self, modes: &Modes) -> Option<(usize, f64)> {
        let breakables = self.system.contacts.breakables.iter().zip(&modes.broken).enumerate();
        // Rods whose tensions have no meaning do not break.
        let is_meant = |constraint: usize| !self.system.is_second_order(constraint);
        let whole = breakables.filter(|(_, (breakable, broken))| !**broken && is_meant(breakable.constraint));
        let carried = whole.map(|(number, (breakable, _))| {
            let impulses = breakable.rows.clone().map(|row| self.equation.lambda[row].abs());
            (number, impulses.fold(0.0, larger), breakable.impulse_limit)
        });
        let over = carried.filter(|(_, impulse, limit)| impulse > limit);
        over.max_by(|(_, a, la), (_, b, lb)| (a / la).total_cmp(&(b / lb)))
            .map(|(number, impulse, _)| (number, impulse))
    }

    /// The impact of closing contacts on those that are near, with the links that are whole. Returns the energy lost
    /// [J].
    fn collide_once(
        &mut self,
        modes: &Modes,
        near: &[usize],
        closing: &[usize],
        resolved: &mut Resolved,
    ) -> Result<f64, NoConsistentModes> {
        let bounce_speed = self.bounce_speed();
        let first = resolved.events.len();
        let struck: Vec<usize> = closing.iter().copied().filter(|&k| -self.rate(k) > bounce_speed).collect();
        for &k in &struck {
            let speed = -self.rate(k);
            resolved.events.push(self.event(self.system.contacts.list[k].constraint, EventKind::Impact { speed }));
        }
        let touching: Vec<Touching> = near.iter().map(|&k| self.touching(k, true, false)).collect();
        let bounces: Vec<bool> = near.iter().map(|&k| -self.rate(k) > bounce_speed).collect();
        let mut during = modes.clone();
        for touching in touching.iter().filter(|touching| closing.contains(&touching.contact)) {
            during.contacts[touching.contact] = touching.closed();
        }
        let EventResolution { equation, system, qd, .. } = self;
        let lost = Impact::<D> { equation, system, touching: &touching, qd }.collide(&mut during, &bounces)?;
        for (event, k) in resolved.events[first..].iter_mut().zip(struck) {
            event.impulse = self.equation.lambda[self.system.contacts.list[k].normal];
        }
        if bounces.contains(&true) {
            resolved.warnings.extend(self.shared(near));
        }
        Ok(lost)
    }
}
