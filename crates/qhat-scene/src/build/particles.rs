//! `[[particles]]`.

use super::Assembly;
use crate::model::Particle;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_particles(&mut self, particles: &[Particle]) {
        for (index, particle) in particles.iter().enumerate() {
            let place = self.tree.key("particles").item(index);
            let id = &particle.id.0;
            let velocity = particle.velocity.as_ref();
            if particle.fixed && velocity.is_some_and(|v| v.0.iter().any(|&v| v != 0.0)) {
                let message = format!("the fixed particle {} cannot have a velocity", self.report.quoted(id));
                let help = "leave out `velocity`, or `fixed`".to_owned();
                self.report.error(place.key("velocity").span.clone(), message, Some(help));
                continue;
            }
            let added = self.builder.particle(qhat::Particle {
                name: id.clone(),
                position: particle.at.0.clone(),
                velocity: velocity.map_or_else(|| vec![0.0; self.dimension], |velocity| velocity.0.clone()),
                mass: particle.mass,
                fixed: particle.fixed,
            });
            self.positions.extend(&particle.at.0);
            self.is_fixed.push(particle.fixed);
            let span = place.key("id").span.clone();
            if let Err(first) = self.ids.take(id, added, span.clone()) {
                let message = format!("the id {} is given twice", self.report.quoted(id));
                let line = self.report.line_of(first.start);
                let help = format!("the first is in line {line}; each particle needs an id of its own");
                self.report.error(span, message, Some(help));
            }
        }
    }
}
