//! Actuator: a push along the line between two particles, the sum of a constant and an oscillating part.
//!
//! ```text
//! f = f₀ + f₁ cos(ω t + φ)                       [N], positive if it pushes its ends apart
//! F_a = f n,   F_b = −f n                        [N], L and n as in `line.rs`
//! power = f L̇·n                                  [W], of either sign, the constant part included
//! −∂F_a/∂x_a = −f (I − nnᵀ)/|L|                  [N/m]
//! ```
//!
//! At |L| = 0 the direction is undefined, and the force is zero. An actuator between the ends of a rod does no work and
//! changes only the tension of the rod.

use super::line::Line;
use super::{Acts, Dependence, ForceError};
use crate::allowed::finite;
use crate::point::{Motion, add, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Push along the line between two particles, the sum of a constant and an oscillating part.
#[derive(Clone, Debug, PartialEq)]
pub struct Actuator {
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// f₀ \[N\].
    pub push: f64,
    /// f₁ \[N\].
    pub amplitude: f64,
    /// ω [rad/s].
    pub angular_frequency: f64,
    /// φ \[rad\].
    pub phase: f64,
}

impl Actuator {
    /// f.
    fn now<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        self.push + self.amplitude * libm::cos(self.angular_frequency * motion.t + self.phase)
    }
}

impl Acts for Actuator {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        if let Some(Line { n, .. }) = Line::between(motion, self.a, self.b) {
            let f = self.now(motion);
            add(Q, self.a, scaled(f, n));
            add(Q, self.b, scaled(-f, n));
        }
    }

    fn potential<const D: usize>(&self, _: Motion<'_, D>, _: &[f64]) -> f64 {
        0.0
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        Line::between(motion, self.a, self.b).map_or(0.0, |line| self.now(motion) * line.rate)
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let Some(Line { length, .. }) = Line::between(motion, self.a, self.b) else { return };
        // The bound uses the largest |f| at any time; the row sum has a block for each end.
        let both_ends = 2.0 * (self.push.abs() + self.amplitude.abs()) / length;
        bound(self.a, both_ends, 0.0);
        bound(self.b, both_ends, 0.0);
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
        if let Some(line) = Line::between(motion, self.a, self.b) {
            let geometric = line.across(-self.now(motion) / line.length);
            visit(self.a, self.b, Stiffness::Difference(geometric));
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn check(&self) -> Result<(), ForceError> {
        finite("the push of an actuator", self.push)?;
        finite("the amplitude of an actuator", self.amplitude)?;
        finite("the angular frequency of an actuator", self.angular_frequency)?;
        finite("the phase of an actuator", self.phase)?;
        if self.a == self.b { Err(ForceError::SameEnds { what: "an actuator" }) } else { Ok(()) }
    }
}
