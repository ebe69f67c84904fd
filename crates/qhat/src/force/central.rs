//! CentralForce: an inverse-square force between one particle and a fixed point p: the law of `inverse_square.rs`
//! with d = x − p. For gravity towards p, s = −μ m with μ = G M [m³/s²].

use super::inverse_square::Law;
use super::{Acts, Dependence, ForceError};
use crate::allowed::all_finite;
use crate::point::{Motion, Point, add, first, minus};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Inverse-square force between one particle and a point.
#[derive(Clone, Debug, PartialEq)]
pub struct CentralForce {
    /// The particle it acts on.
    pub particle: ParticleId,
    /// p \[m\]; the third component is ignored in two dimensions.
    pub center: [f64; 3],
    /// s [N·m²]; −μ m for gravity. A negative s attracts.
    pub strength: f64,
    /// ε, the softening length \[m\], not negative.
    pub softening: f64,
}

impl CentralForce {
    /// Gravity of a particle of the given mass \[kg\] towards a point \[m\]; μ = G M in m³/s², the softening length in
    /// m.
    pub fn gravity(particle: ParticleId, mass: f64, center: [f64; 3], mu: f64, softening: f64) -> Self {
        CentralForce { particle, center, strength: -mu * mass, softening }
    }

    fn law(&self) -> Law {
        Law { s: self.strength, epsilon: self.softening }
    }

    fn away<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        minus(motion.x(self.particle), first::<D>(&self.center))
    }
}

impl Acts for CentralForce {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        add(Q, self.particle, self.law().force(self.away(motion)));
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        self.law().potential(self.away(motion))
    }

    fn power<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        0.0
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        bound(self.particle, self.law().bound(self.away(motion)), 0.0);
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        _: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        for term in self.law().stiffness(self.away(motion)).into_iter().flatten() {
            visit(self.particle, self.particle, Stiffness::Difference(term));
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn check(&self) -> Result<(), ForceError> {
        self.law().check()?;
        Ok(all_finite("the centre of a central force", &self.center)?)
    }
}
