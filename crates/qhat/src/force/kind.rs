//! What every kind of force answers.

use super::ForceError;
use crate::point::Motion;
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// What every force answers. `mass` is [kg], one per particle.
pub(crate) trait Acts {
    /// Adds this force to Q.
    fn add<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64], Q: &mut [f64]);

    /// Potential energy [J]; zero for a force that has none.
    fn potential<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64]) -> f64;

    /// Power of the part that no potential accounts for [W]; negative where energy is taken.
    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `bound(particle, stiffness [N/m], damping [N·s/m])` with a bound on the row sums of −∂Q/∂q and −∂Q/∂q̇:
    /// what limits the step of an explicit method.
    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64));

    /// What it changes with, while nothing but the motion goes on.
    fn dependence(&self) -> Dependence;

    /// Calls `visit(i, j, block)` with −∂Q/∂q − rate ∂Q/∂q̇ [N/m], for a method that solves at the end of the step, where q̇
    /// follows q at `rate` [1/s]. Any two particles that it couples must be among those it names.
    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    );

    /// The only number of dimensions it fits, if there is one.
    fn dimension(&self) -> Option<usize> {
        None
    }

    /// The particles this force names, each once; empty when it acts on all.
    fn particles(&self) -> Vec<ParticleId>;

    /// `Ok` if its numbers are in range.
    fn check(&self) -> Result<(), ForceError>;
}

/// What a force changes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dependence {
    /// Nothing: it is the same at every motion.
    Nothing,
    /// −coefficient q̇ on every particle [N·s/m].
    Drag(f64),
    /// The positions and velocities of the particles it names, and the time.
    Motion,
}
