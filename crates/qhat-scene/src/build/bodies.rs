//! `[[bodies]]`: particles of bodies come after those of `[[generate]]`, their rods and midpoints after its links.

use super::{Assembly, MOST_PARTICLES};
use crate::model::body::{Body, Common};
use crate::scene::SceneBody;
use qhat::{Distance, Particle, ParticleId, Relation};
use std::ops::Range;

/// A body whose particles are added and whose rods and midpoints are not.
pub(super) struct Unheld {
    body: qhat::Body,
    ids: Vec<ParticleId>,
    prefix: String,
}

impl Assembly<'_, '_, '_> {
    /// Adds the particles of all bodies; `None` after an error, because later errors about missing ids would mislead.
    pub(super) fn add_bodies(&mut self, bodies: &[Body]) -> Option<Vec<Unheld>> {
        let mut unheld = Vec::new();
        for (index, body) in bodies.iter().enumerate() {
            let place = self.tree.key("bodies").item(index);
            match (body.make(self.dimension), body.spin(self.dimension)) {
                (Ok(made), Ok(spin)) => unheld.extend(self.add_body(body, made, spin, place.span.clone())),
                (Err(refusal), _) | (_, Err(refusal)) => {
                    self.report.error(place.key(refusal.key).span.clone(), refusal.message, Some(refusal.help.into()));
                }
            }
        }
        (unheld.len() == bodies.len()).then_some(unheld)
    }

    fn add_body(&mut self, body: &Body, made: qhat::Body, spin: [f64; 3], place: Range<usize>) -> Option<Unheld> {
        let first = self.positions.len() / self.dimension;
        if (first + made.points.len()) as u64 > MOST_PARTICLES {
            let message = format!("with this body the scene has more than {MOST_PARTICLES} particles");
            self.report.error(place, message, Some("ask for fewer particles".into()));
            return None;
        }
        let Common { prefix, velocity, .. } = body.common();
        let velocities = made.velocities(velocity, spin);
        let mut ids = Vec::with_capacity(made.points.len());
        for (i, ((x, v), &mass)) in made.points.iter().zip(&velocities).zip(&made.masses).enumerate() {
            if !x.iter().chain(v).all(|number| number.is_finite()) {
                let message = "the positions or velocities of this body's particles are not finite numbers";
                self.report.error(place, message, Some("use smaller numbers".into()));
                return None;
            }
            let name = format!("{prefix}{i}");
            let (position, velocity) = (x[..self.dimension].to_vec(), v[..self.dimension].to_vec());
            self.positions.extend(&position);
            self.is_fixed.push(false);
            let added = self.builder.particle(Particle { name: name.clone(), position, velocity, mass, fixed: false });
            ids.push(added);
            if let Err(origin) = self.ids.take(&name, added, place.clone()) {
                let message = format!("this body makes a particle {}, but that id is taken", self.report.quoted(&name));
                let line = self.report.line_of(origin.start);
                self.report.error(place, message, Some(format!("the first is in line {line}; use another `prefix`")));
                return None;
            }
        }
        Some(Unheld { body: made, ids, prefix: prefix.to_owned() })
    }

    /// Adds the rods and midpoints of all bodies.
    pub(super) fn hold_bodies(&mut self, unheld: Vec<Unheld>) {
        for Unheld { body, ids, prefix } in unheld {
            for (rod, &[a, b]) in body.rods.iter().enumerate() {
                let name = self.free_name(format!("{prefix}{a}-{prefix}{b}"));
                let [a, b] = [a, b].map(|end| ids[end]);
                self.builder.constraint(name, Distance::new(a, b, body.length(rod)));
            }
            for &[middle, a, b] in &body.midpoints {
                let name = self.free_name(format!("midpoint({prefix}{middle})"));
                let [middle, a, b] = [middle, a, b].map(|particle| ids[particle]);
                self.builder.constraint(name, Relation::midpoint(middle, a, b));
            }
            self.bodies.push(SceneBody { name: prefix, particles: ids });
        }
    }
}
