//! Kind: the questions that every kind of force answers, and the types of the answers.

use super::ForceError;
use crate::linalg::block::{Block, zero};
use crate::point::Motion;
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// The questions that every force answers. `mass` has the mass of each particle [kg].
pub(crate) trait Acts {
    /// Adds this force to Q.
    fn add<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64], Q: &mut [f64]);

    /// Potential energy [J]; zero for a force without a potential.
    fn potential<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64]) -> f64;

    /// Power of the part that has no potential [W]; negative if it takes energy from the particles.
    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `bound(particle, stiffness [N/m], damping [N·s/m])` with bounds on the row sums of −∂Q/∂q and −∂Q/∂q̇: the
    /// sum of the norms of the blocks of a particle, or the largest sum of the entries of one component. The bounds
    /// limit the step of an explicit method.
    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64));

    /// The arguments that the force depends on between two changes of its numbers.
    fn dependence(&self) -> Dependence;

    /// Calls `visit(i, j, block)` with −∂Q/∂q − rate ∂Q/∂q̇ [N/m], for an implicit method, in which q̇ changes with q
    /// at `rate` [1/s]. A force may couple only particles that `particles` names.
    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    );

    /// Calls `visit(i, j, −∂Q_i/∂x_j [N/m], −∂Q_i/∂v_j [N·s/m])`, exact and in both orders of each pair. This is the
    /// default, for forces that do not depend on velocities; their stiffness is symmetric.
    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        self.tangent::<D>(motion, 0.0, &mut |i, j, stiffness| {
            stiffness.blocks((i, j), &mut |row, column, block| visit(row, column, block, zero()));
        });
    }

    /// The only number of dimensions in which the force can be used; `None` if it can be used in two and in three.
    fn dimension(&self) -> Option<usize> {
        None
    }

    /// The particles that the force names, each once; empty if it acts on all.
    fn particles(&self) -> Vec<ParticleId>;

    /// `Ok` if the numbers of the force are allowed; the error names the number that is not.
    fn check(&self) -> Result<(), ForceError>;
}

/// The arguments that a force depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dependence {
    /// No argument: the force is constant.
    Nothing,
    /// The velocity of each particle: the force is −coefficient q̇ [N·s/m] on every particle.
    Drag(f64),
    /// The positions and velocities of the particles that the force names, and the time.
    Motion,
}
