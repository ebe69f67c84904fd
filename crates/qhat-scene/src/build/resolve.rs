//! From the ids in a scene to particles, and the values of particles at the start.

use super::Assembly;
use crate::model::Id;
use crate::tree::Node;
use qhat::ParticleId;
use std::collections::HashSet;

impl Assembly<'_, '_, '_> {
    /// The particle with this id.
    pub(super) fn particle(&mut self, Id(id): &Id, place: &Node) -> Option<ParticleId> {
        let found = self.ids.find(id);
        if found.is_none() && !self.report.is_full() {
            let message = format!("there is no particle {}", self.report.quoted(id));
            self.report.error(place.span.clone(), message, Some(self.ids.help(id)));
        }
        found
    }

    /// Two different particles; `list` is the place of their ids.
    pub(super) fn pair(&mut self, ids: &[Id; 2], list: &Node) -> Option<(ParticleId, ParticleId)> {
        let [one, other] = ids;
        let (a, b) = (self.particle(one, list.item(0)), self.particle(other, list.item(1)));
        let pair = (a?, b?);
        if pair.0 == pair.1 {
            let message = format!("{} cannot be connected to itself", self.report.quoted(&one.0));
            self.report.error(list.span.clone(), message, Some("name two different particles".into()));
            return None;
        }
        Some(pair)
    }

    /// The particles with these ids; one may be named several times.
    pub(super) fn particles(&mut self, ids: &[Id], list: &Node) -> Option<Vec<ParticleId>> {
        let found: Vec<_> = ids.iter().enumerate().map(|(k, id)| self.particle(id, list.item(k))).collect();
        found.into_iter().collect()
    }

    /// The particles with these ids, all different.
    pub(super) fn different(&mut self, ids: &[Id], list: &Node) -> Option<Vec<ParticleId>> {
        let found = self.particles(ids, list)?;
        let mut seen = HashSet::new();
        if let Some(k) = found.iter().position(|id| !seen.insert(*id)) {
            let message = format!("{} is named twice", self.report.quoted(&ids[k].0));
            self.report.error(list.item(k).span.clone(), message, Some("name different particles".into()));
            return None;
        }
        Some(found)
    }

    /// The particles with these ids, each with the place of its own id, all different.
    pub(super) fn different_at<const K: usize>(&mut self, ids: [(&Id, &Node); K]) -> Option<[ParticleId; K]> {
        let found = ids.map(|(id, place)| self.particle(id, place));
        for i in 1..K {
            if found[i].is_some() && found[..i].contains(&found[i]) {
                let (id, place) = ids[i];
                let message = format!("{} is named twice in one constraint", self.report.quoted(&id.0));
                self.report.error(place.span.clone(), message, Some("name different particles".into()));
                return None;
            }
        }
        if found.iter().any(Option::is_none) { None } else { Some(found.map(|id| id.expect("found"))) }
    }

    /// The particles under the key `particles`, all different; every particle that is not fixed where the key is left
    /// out.
    pub(super) fn listed_or_free(&mut self, ids: Option<&[Id]>, place: &Node) -> Option<Vec<ParticleId>> {
        match ids {
            Some(ids) => self.different(ids, place.key("particles")),
            None => {
                let free = (0..self.is_fixed.len()).filter(|&i| !self.is_fixed[i]);
                free.map(|i| self.builder.particle_at(i)).collect()
            }
        }
    }

    /// The position of a particle at the start [m], with three components as the engine takes points.
    pub(super) fn start(&self, particle: ParticleId) -> [f64; 3] {
        let start = &self.start_positions()[particle.index() * self.dimension..][..self.dimension];
        std::array::from_fn(|k| start.get(k).copied().unwrap_or(0.0))
    }

    /// The distance of two particles at the start [m].
    pub(super) fn distance(&self, a: ParticleId, b: ParticleId) -> f64 {
        let (d, a, b) = (self.dimension, a.index(), b.index());
        let q = self.start_positions();
        let squares = (0..d).map(|k| q[a * d + k] - q[b * d + k]).map(|x| x * x);
        squares.sum::<f64>().sqrt()
    }
}
