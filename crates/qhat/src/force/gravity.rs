//! Gravity: uniform gravity.
//!
//! ```text
//! F_i = m_i g                    [N]
//! V   = −Σ m_i g · x_i           [J]
//! ```

use super::{Acts, Dependence, ForceError};
use crate::allowed::all_finite;
use crate::point::{Motion, Vector, add, dot, first, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Uniform gravity on every particle.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// g [m/s²]; the third component is ignored in two dimensions.
    pub acceleration: [f64; 3],
}

impl Gravity {
    /// Uniform gravity of an acceleration [m/s²].
    pub fn new(acceleration: impl Into<Vector>) -> Self {
        Gravity { acceleration: acceleration.into().0 }
    }
}

impl Acts for Gravity {
    fn add<const D: usize>(&self, _: Motion<'_, D>, mass: &[f64], Q: &mut [f64]) {
        let g = first::<D>(&self.acceleration);
        for (i, &m) in mass.iter().enumerate() {
            add(Q, ParticleId(i), scaled(m, g));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64]) -> f64 {
        let g = first::<D>(&self.acceleration);
        -mass.iter().enumerate().map(|(i, m)| m * dot(g, motion.x(ParticleId(i)))).sum::<f64>()
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
        Vec::new()
    }

    fn check(&self) -> Result<(), ForceError> {
        Ok(all_finite("gravity", &self.acceleration)?)
    }
}
