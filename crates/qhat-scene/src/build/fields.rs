//! `[[loads]]` of fields: gravity towards a point and between particles, electrostatics, drag in air.

use super::Assembly;
use crate::model::Vector;
use crate::model::fields::{AirDrag, CentralGravity, Charges, PairwiseGravity};
use crate::tree::Node;
use qhat::{CentralForce, InverseSquare};

impl Assembly<'_, '_, '_> {
    pub(super) fn add_central_gravity(&mut self, it: &CentralGravity, place: &Node) -> Option<()> {
        for particle in self.listed_or_free(it.particles.as_deref(), place)? {
            let (center, mass) = (it.center.padded(), self.weighed(particle));
            self.builder.force(CentralForce::gravity(particle, mass, center, it.mu, it.softening));
        }
        Some(())
    }

    pub(super) fn add_pairwise_gravity(&mut self, it: &PairwiseGravity, place: &Node) -> Option<()> {
        let particles = self.different(&it.particles, place.key("particles"))?;
        for (i, &b) in particles.iter().enumerate() {
            for &a in &particles[..i] {
                let pair = [self.weighed(a), self.weighed(b)];
                self.builder.force(InverseSquare::gravity([a, b], pair, it.constant, it.softening));
            }
        }
        Some(())
    }

    pub(super) fn add_charges(&mut self, it: &Charges, place: &Node) -> Option<()> {
        let particles = self.different(&it.particles, place.key("particles"))?;
        if it.charges.len() != particles.len() {
            let message = format!("there are {} charges for {} particles", it.charges.len(), particles.len());
            let help = "give one charge for each particle".to_owned();
            self.report.error(place.key("charges").span.clone(), message, Some(help));
            return None;
        }
        for (i, (&b, &other)) in particles.iter().zip(&it.charges).enumerate() {
            for (&a, &one) in particles.iter().zip(&it.charges).take(i) {
                self.builder.force(InverseSquare::charges([a, b], [one, other], it.constant, it.softening));
            }
        }
        Some(())
    }

    pub(super) fn add_air_drag(&mut self, it: &AirDrag, place: &Node) -> Option<()> {
        let rows = it.gradient.as_deref().unwrap_or_default();
        if it.gradient.is_some() && rows.len() != self.dimension {
            let message = format!("the gradient of the wind has {} vectors, not {}", rows.len(), self.dimension);
            let help = "give one for each component of the wind".to_owned();
            self.report.error(place.key("gradient").span.clone(), message, Some(help));
            return None;
        }
        let gradient = std::array::from_fn(|k| rows.get(k).map_or([0.0; 3], Vector::padded));
        let wind = it.wind.as_ref().map_or([0.0; 3], Vector::padded);
        for particle in self.listed_or_free(it.particles.as_deref(), place)? {
            let still = qhat::AirDrag::still(particle, it.linear, it.quadratic);
            self.builder.force(qhat::AirDrag { wind, gradient, ..still });
        }
        Some(())
    }
}
