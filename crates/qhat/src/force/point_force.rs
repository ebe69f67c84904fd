//! PointForce: a constant force on one particle.
//!
//! ```text
//! F = f                          [N]
//! V = −f · x                     [J]
//! ```

use super::{Acts, Dependence, ForceError};
use crate::allowed::all_finite;
use crate::point::{Motion, Vector, add, dot, first};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Constant force on one particle.
#[derive(Clone, Debug, PartialEq)]
pub struct PointForce {
    /// The particle it acts on.
    pub particle: ParticleId,
    /// f \[N\]; the third component is ignored in two dimensions.
    pub force: [f64; 3],
}

impl PointForce {
    /// A constant force \[N\] on a particle.
    pub fn new(particle: ParticleId, force: impl Into<Vector>) -> Self {
        PointForce { particle, force: force.into().0 }
    }
}

impl Acts for PointForce {
    fn add<const D: usize>(&self, _: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        add(Q, self.particle, first::<D>(&self.force));
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        -dot(first::<D>(&self.force), motion.x(self.particle))
    }

    fn power<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        0.0
    }

    fn stiffness<const D: usize>(&self, _: Motion<'_, D>, _: &mut impl FnMut(ParticleId, f64, f64)) {}

    fn dependence(&self) -> Dependence {
        Dependence::Nothing
    }

    fn tangent<const D: usize>(
        &self,
        _: Motion<'_, D>,
        _: f64,
        _: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn check(&self) -> Result<(), ForceError> {
        Ok(all_finite("a point force", &self.force)?)
    }
}
