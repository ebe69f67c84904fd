//! HarmonicForce: a force on one particle that oscillates with time.
//!
//! ```text
//! F = f cos(ω t + φ)             [N]
//! power = F · v                  [W], of either sign; the force has no potential
//! ```

use super::{Acts, Dependence, ForceError};
use crate::allowed::{all_finite, finite};
use crate::point::{Motion, Point, add, dot, first, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Force on one particle that oscillates with time.
#[derive(Clone, Debug, PartialEq)]
pub struct HarmonicForce {
    /// The particle it acts on.
    pub particle: ParticleId,
    /// f \[N\]; the third component is ignored in two dimensions.
    pub amplitude: [f64; 3],
    /// ω [rad/s].
    pub angular_frequency: f64,
    /// φ \[rad\].
    pub phase: f64,
}

impl HarmonicForce {
    fn force<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        let now = libm::cos(self.angular_frequency * motion.t + self.phase);
        scaled(now, first::<D>(&self.amplitude))
    }
}

impl Acts for HarmonicForce {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        add(Q, self.particle, self.force(motion));
    }

    fn potential<const D: usize>(&self, _: Motion<'_, D>, _: &[f64]) -> f64 {
        0.0
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        dot(self.force(motion), motion.v(self.particle))
    }

    fn stiffness<const D: usize>(&self, _: Motion<'_, D>, _: &mut impl FnMut(ParticleId, f64, f64)) {}

    // A force that depends on nothing is evaluated once for each frame. This force depends on t, which counts as
    // motion.
    fn dependence(&self) -> Dependence {
        Dependence::Motion
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
        all_finite("the amplitude of a harmonic force", &self.amplitude)?;
        finite("the angular frequency of a harmonic force", self.angular_frequency)?;
        Ok(finite("the phase of a harmonic force", self.phase)?)
    }
}
