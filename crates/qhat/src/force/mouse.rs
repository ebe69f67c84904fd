//! MouseSpring: a damped spring of rest length zero between a particle and a point p that a hand moves.
//!
//! ```text
//! F = −ks (x − p) − kd v         [N]
//! V = ½ ks |x − p|²              [J]
//! power of the damper = −kd v·v  [W]
//! ```
//!
//! p moves between steps and never within a step. The work of moving p is the jump of V, which `Simulation` adds to its
//! account of energy.

use super::{Acts, Dependence, ForceError};
use crate::allowed::{all_finite, not_negative};
use crate::linalg::block::{Block, diagonal};
use crate::point::{Motion, add, dot, first, minus, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Damped spring between one particle and a point that a hand moves.
#[derive(Clone, Debug, PartialEq)]
pub struct MouseSpring {
    /// The particle that is pulled.
    pub particle: ParticleId,
    /// p \[m\]; the third component is ignored in two dimensions.
    pub target: [f64; 3],
    /// ks [N/m], not negative.
    pub stiffness: f64,
    /// kd [N·s/m], not negative.
    pub damping: f64,
}

impl Acts for MouseSpring {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let away = minus(motion.x(self.particle), first::<D>(&self.target));
        add(Q, self.particle, scaled(-self.stiffness, away));
        add(Q, self.particle, scaled(-self.damping, motion.v(self.particle)));
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let away = minus(motion.x(self.particle), first::<D>(&self.target));
        0.5 * self.stiffness * dot(away, away)
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let v = motion.v(self.particle);
        -self.damping * dot(v, v)
    }

    fn stiffness<const D: usize>(&self, _: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        bound(self.particle, self.stiffness, self.damping);
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        _: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        let stiffness = diagonal(self.stiffness + rate * self.damping);
        visit(self.particle, self.particle, Stiffness::Difference(stiffness));
    }

    fn linearize<const D: usize>(
        &self,
        _: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        visit(self.particle, self.particle, diagonal(self.stiffness), diagonal(self.damping));
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn check(&self) -> Result<(), ForceError> {
        not_negative("the stiffness of the mouse spring", self.stiffness)?;
        not_negative("the damping of the mouse spring", self.damping)?;
        Ok(all_finite("the target of the mouse spring", &self.target)?)
    }
}
