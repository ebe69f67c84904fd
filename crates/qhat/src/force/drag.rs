//! Drag: viscous drag, which slows every particle. The source calls it damping.
//!
//! ```text
//! F_i = −kd v_i                  [N], kd in N·s/m
//! power = −kd Σ v_i · v_i        [W]
//! ```

use super::{Acts, Dependence, ForceError};
use crate::allowed::not_negative;
use crate::linalg::block::{Block, diagonal, zero};
use crate::point::{Motion, add, dot, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Viscous drag on every particle.
#[derive(Clone, Debug, PartialEq)]
pub struct Drag {
    /// kd [N·s/m], not negative.
    pub coefficient: f64,
}

impl Acts for Drag {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64], Q: &mut [f64]) {
        for i in (0..mass.len()).map(ParticleId) {
            add(Q, i, scaled(-self.coefficient, motion.v(i)));
        }
    }

    fn potential<const D: usize>(&self, _: Motion<'_, D>, _: &[f64]) -> f64 {
        0.0
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let particles = motion.q.len() / D;
        -self.coefficient * (0..particles).map(|i| motion.v(ParticleId(i))).map(|v| dot(v, v)).sum::<f64>()
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        if self.coefficient > 0.0 {
            for i in 0..motion.q.len() / D {
                bound(ParticleId(i), 0.0, self.coefficient);
            }
        }
    }

    fn dependence(&self) -> Dependence {
        Dependence::Drag(self.coefficient)
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        let stiffness = Stiffness::Difference(diagonal(rate * self.coefficient));
        if self.coefficient > 0.0 {
            for i in 0..motion.q.len() / D {
                visit(ParticleId(i), ParticleId(i), stiffness);
            }
        }
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        for i in (0..motion.q.len() / D).map(ParticleId) {
            visit(i, i, zero(), diagonal(self.coefficient));
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        Vec::new()
    }

    fn check(&self) -> Result<(), ForceError> {
        Ok(not_negative("the drag coefficient", self.coefficient)?)
    }
}
