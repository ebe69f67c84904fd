//! Forces as expressions: one expression for each component of a force on one particle, or one expression for a
//! potential energy.
//!
//! Force, of positions, velocities and time [N]:
//!
//! ```text
//! F = (F_1, …, F_d),   power = F·v                              [W]
//! −∂F_k/∂x_j − rate ∂F_k/∂v_j     from the gradient of F_k
//! ```
//!
//! F may depend on particles that feel no force themselves, so the stiffness K is not symmetric. Implicit methods use
//! the symmetric part ½ (K + Kᵀ) in their matrix. The antisymmetric part, which is left out, costs iterations and not
//! accuracy.
//!
//! Potential, of positions and time [J]:
//!
//! ```text
//! F_i = −∂V/∂x_i,   −∂F_i/∂x_j = ∂²V/∂x_i∂x_j
//! d(T + V)/dt = ∂V/∂t, the power of an agent that changes V with time     [W]
//! ```
//!
//! The sign of the stiffness is not known for either. If a number is not finite, the step ends in `StepError`.

use super::{Acts, Dependence, ForceError};
use crate::expression::{Expression, LONGEST_GRADIENT, MAX_NAMES};
use crate::linalg::block::{Block, plus, transposed, zero};
use crate::point::{Motion, Point, add, dot};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// A force on one particle, with an expression for each component.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionForce {
    /// The particle it acts on.
    pub particle: ParticleId,
    /// The d components of F \[N\].
    pub components: Vec<Expression>,
}

/// A potential energy V as an expression. The force on every particle in V is −∂V/∂x.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionPotential {
    /// V \[J\].
    pub potential: Expression,
}

impl ExpressionForce {
    fn value<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        std::array::from_fn(|k| self.components[k].value(motion.q, motion.qd, motion.t))
    }

    /// Calls `visit(k, j, ∂F_k/∂x_j, ∂F_k/∂v_j)`.
    fn slopes<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(usize, ParticleId, Point<D>, Point<D>),
    ) {
        let mut by_position = [0.0; LONGEST_GRADIENT];
        let mut by_velocity = [0.0; LONGEST_GRADIENT];
        for (k, component) in self.components.iter().enumerate() {
            by_velocity.fill(0.0);
            component.gradient(motion.q, motion.qd, motion.t, &mut by_position, &mut by_velocity);
            for (j, &particle) in component.particles().iter().enumerate() {
                let of = |gradient: &[f64]| std::array::from_fn(|l| gradient[j * D + l]);
                visit(k, particle, of(&by_position), of(&by_velocity));
            }
        }
    }
}

impl Acts for ExpressionForce {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        add(Q, self.particle, self.value(motion));
    }

    fn potential<const D: usize>(&self, _: Motion<'_, D>, _: &[f64]) -> f64 {
        0.0
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        dot(self.value(motion), motion.v(self.particle))
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let mut stiffness = [0.0; D];
        let mut damping = [0.0; D];
        self.slopes::<D>(motion, &mut |k, _, by_position, by_velocity| {
            stiffness[k] += sum_of_sizes(by_position);
            damping[k] += sum_of_sizes(by_velocity);
        });
        bound(self.particle, largest(stiffness), largest(damping));
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        self.slopes::<D>(motion, &mut |k, particle, by_position, by_velocity| {
            let mut half = zero::<D>();
            half[k] = std::array::from_fn(|l| -0.5 * (by_position[l] + rate * by_velocity[l]));
            let block = if particle == self.particle { plus(half, 1.0, transposed(&half)) } else { half };
            visit(self.particle, particle, Stiffness::Indefinite(block));
        });
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        self.slopes::<D>(motion, &mut |k, particle, by_position, by_velocity| {
            let row = |slopes: Point<D>| {
                let mut block = zero::<D>();
                block[k] = slopes.map(|slope| -slope);
                block
            };
            visit(self.particle, particle, row(by_position), row(by_velocity));
        });
    }

    fn dimension(&self) -> Option<usize> {
        Some(self.components.len())
    }

    fn particles(&self) -> Vec<ParticleId> {
        let mut particles = vec![self.particle];
        for &particle in self.components.iter().flat_map(Expression::particles) {
            if !particles.contains(&particle) {
                particles.push(particle);
            }
        }
        particles
    }

    fn check(&self) -> Result<(), ForceError> {
        let d = self.components.len();
        match self.components.iter().find(|component| component.dimension() != d) {
            Some(other) => Err(ForceError::Components { count: d, written: other.dimension() }),
            None => Ok(()),
        }
    }
}

impl Acts for ExpressionPotential {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let mut gradient = [0.0; LONGEST_GRADIENT];
        self.potential.gradient(motion.q, motion.qd, motion.t, &mut gradient, &mut []);
        for (g, &particle) in gradient.chunks_exact(D).zip(self.potential.particles()) {
            add(Q, particle, std::array::from_fn::<f64, D, _>(|k| -g[k]));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        self.potential.value(motion.q, motion.qd, motion.t)
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        if !self.potential.uses_time() {
            return 0.0;
        }
        self.potential.jet_and_gradient(motion.q, motion.qd, motion.t, &mut [0.0; LONGEST_GRADIENT]).1
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let mut sums = [[0.0; D]; MAX_NAMES];
        self.potential.hessian_blocks(motion, &mut |i, j, block: Block<D>| {
            for k in 0..D {
                sums[i][k] += sum_of_sizes(block[k]);
                if i != j {
                    sums[j][k] += sum_of_sizes(transposed(&block)[k]);
                }
            }
        });
        for (&particle, &sum) in self.potential.particles().iter().zip(&sums) {
            bound(particle, largest(sum), 0.0);
        }
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
        let particles = self.potential.particles();
        self.potential.hessian_blocks(motion, &mut |i, j, block: Block<D>| {
            visit(particles[i], particles[j], Stiffness::Indefinite(block));
        });
    }

    fn dimension(&self) -> Option<usize> {
        Some(self.potential.dimension())
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.potential.particles().to_vec()
    }

    fn check(&self) -> Result<(), ForceError> {
        if self.potential.uses_velocities() {
            return Err(ForceError::DependsOnVelocities);
        }
        if self.potential.particles().is_empty() {
            return Err(ForceError::DependsOnNothing);
        }
        Ok(())
    }
}

/// Σ |x|.
pub(super) fn sum_of_sizes<const D: usize>(x: Point<D>) -> f64 {
    x.iter().map(|component| component.abs()).sum()
}

pub(super) fn largest<const D: usize>(x: Point<D>) -> f64 {
    x.iter().fold(0.0, |most: f64, &component| most.max(component))
}
