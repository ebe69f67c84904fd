//! Smooth: constraints that are written as C and its gradient alone. All other derivatives follow from the same
//! formulas, evaluated on numbers that carry a derivative along one direction.
//!
//! ```text
//! along (q + τ q̇, t + τ):   J ↦ J + J̇ ε,   C_t ↦ C_t + Ċ_t ε
//! Ċ = J q̇ + C_t
//! γ = J̇ q̇ + Ċ_t            = (∂(J q̇)/∂q) q̇ + J_t q̇ + J_t q̇ + C_tt
//! along coordinate k of particle j:   J_i ↦ J_i + (∂²C/∂x_i ∂x_jk) ε, one column of the geometric stiffness
//! ```
//!
//! A kind writes its residual and its gradient once, over numbers that may carry a derivative (`number.rs`). Nothing
//! else is derived by hand.

use super::{ConstraintError, Formulation, Holds, RowWriter};
use crate::linalg::block::{Block, zero};
use crate::number::{Dual, Number};
use crate::point::{Motion, dot};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// A constraint whose rows are smooth functions of positions and time.
pub(crate) trait Smooth: Clone {
    /// The only number of dimensions in which the kind can be used; `None` if it can be used in two and in three.
    const ONLY_IN: Option<usize> = None;

    /// Number of scalar rows in d dimensions.
    fn row_count(&self, _dimension: usize) -> usize {
        1
    }

    /// Whether the rows are the components of one vector.
    fn is_vector(&self) -> bool {
        false
    }

    /// The i-th particle of the constraint; `None` after the last. Each particle comes once.
    fn particle(&self, i: usize) -> Option<ParticleId>;

    /// C and C_t of one row. The gradient ∂C/∂x is handed to `gradient`, particle after particle, in the order of
    /// `particle`.
    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N>;

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// L/EA [m/N] of a rod whose length is driven; zero for every other kind.
    fn flexibility(&self, _t: f64) -> f64 {
        0.0
    }

    /// As [`Holds::may_jump`].
    fn may_jump(&self) -> bool {
        false
    }

    /// As [`Holds::arms`].
    fn arms(&self) -> Vec<[ParticleId; 2]> {
        Vec::new()
    }

    /// As [`Holds::least_size`].
    fn least_size(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// `Ok` if the constraint has a meaning in d dimensions; the error says why it has none.
    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        Self::ONLY_IN.map_or(Ok(()), |only| super::error::only_in(only, dimension))
    }

    /// A bound of the norm of ∂²C/∂x² [C/m²] over k particles, in time proportional to k, for kinds whose rows may be
    /// long; `None` where the second derivatives are to be added up, which takes k² operations.
    fn curvature_bound<const D: usize>(&self, _motion: Motion<'_, D>) -> Option<f64> {
        None
    }

    /// `Ok` if the numbers of the constraint are allowed; the error names the number that is not.
    fn check(&self) -> Result<(), ConstraintError>;
}

/// The arguments of a row: the positions of the particles of its constraint [m] and t [s]. Both carry their derivative
/// along one direction.
pub(crate) struct At<'a, N, const D: usize> {
    motion: Motion<'a, D>,
    particles: &'a [ParticleId],
    along: Along,
    pub(super) t: N,
}

/// Number of particles above which a row is long: a closer bound of its curvature would take longer than its row. The
/// longest rows of the scenes and tests are shorter, so that their substeps stay as they were.
pub(super) const LONG: usize = 256;

/// The direction along which positions and time carry a derivative.
enum Along {
    /// (q̇, 1): the motion itself.
    Motion,
    /// Coordinate k of particle j of the constraint, at a fixed time.
    Coordinate { j: usize, k: usize },
}

impl<N: Number, const D: usize> At<'_, N, D> {
    /// x of the i-th particle of the constraint [m].
    #[inline(always)]
    pub(super) fn x(&self, i: usize) -> [N; D] {
        let place = self.motion.x(self.particles[i]);
        match self.along {
            Along::Motion => {
                let velocity = self.motion.v(self.particles[i]);
                std::array::from_fn(|k| N::of(place[k], velocity[k]))
            }
            Along::Coordinate { j, k: moved } => {
                std::array::from_fn(|k| N::of(place[k], if i == j && k == moved { 1.0 } else { 0.0 }))
            }
        }
    }
}

/// Receives ∂C/∂x [C/m] of one row, particle after particle.
pub(crate) struct Gradient<'a, N, const D: usize>(&'a mut dyn FnMut([N; D]));

impl<N, const D: usize> Gradient<'_, N, D> {
    /// Takes ∂C/∂x of the next particle of the constraint.
    #[inline(always)]
    pub(super) fn push(&mut self, block: [N; D]) {
        (self.0)(block);
    }
}

/// C and C_t of one row.
pub(crate) struct Residual<N> {
    /// C(q, t) [C].
    pub(super) C: N,
    /// ∂C/∂t [C/s], zero where nothing is driven.
    pub(super) C_t: N,
}

/// Number of particles that need no list on the heap. Most kinds name four at most; a rope over pulleys and a closed
/// surface may name more.
const FEW: usize = 8;

/// Runs `body` with the particles of a constraint. Newton's method asks for second derivatives many times in a step, so
/// a short list lies on the stack.
fn with_particles<S: Smooth, R>(constraint: &S, body: impl FnOnce(&[ParticleId]) -> R) -> R {
    let mut few = [ParticleId(0); FEW];
    let mut count = 0;
    while let Some(particle) = constraint.particle(count) {
        let Some(place) = few.get_mut(count) else { return body(&Holds::particles(constraint)) };
        *place = particle;
        count += 1;
    }
    body(&few[..count])
}

/// Calls `visit(j, k, i, column)` with ∂²C/∂x_i ∂x_jk of one row.
fn second_derivatives<S: Smooth, const D: usize>(
    constraint: &S,
    particles: &[ParticleId],
    row: usize,
    motion: Motion<'_, D>,
    visit: &mut impl FnMut(usize, usize, usize, [f64; D]),
) {
    for j in 0..particles.len() {
        for k in 0..D {
            let at = At { motion, particles, along: Along::Coordinate { j, k }, t: Dual::constant(motion.t) };
            let mut i = 0;
            let mut column = |gradient: [Dual; D]| {
                visit(j, k, i, gradient.map(|component| component.slope));
                i += 1;
            };
            constraint.row(row, &at, &mut Gradient(&mut column));
        }
    }
}

impl<S: Smooth> Holds for S {
    fn row_count(&self, dimension: usize) -> usize {
        Smooth::row_count(self, dimension)
    }

    fn is_vector(&self) -> bool {
        Smooth::is_vector(self)
    }

    fn particles(&self) -> Vec<ParticleId> {
        (0..).map_while(|i| self.particle(i)).collect()
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        for row in 0..Smooth::row_count(self, D) {
            rows.write_blocks(|particles, blocks| {
                let at = At { motion, particles, along: Along::Motion, t: Dual { value: motion.t, slope: 1.0 } };
                let (mut rate, mut gamma, mut i) = (0.0, 0.0, 0);
                let mut block = |gradient: [Dual; D]| {
                    let v = motion.v(particles[i]);
                    let J = gradient.map(|component| component.value);
                    rate += dot(J, v);
                    gamma += dot(gradient.map(|component| component.slope), v);
                    blocks[i * D..][..D].copy_from_slice(&J);
                    i += 1;
                };
                let Residual { C, C_t } = self.row(row, &at, &mut Gradient(&mut block));
                debug_assert_eq!(i, particles.len(), "a block for each particle");
                [C.value, rate + C_t.value, gamma + C_t.slope, C_t.value]
            });
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        Smooth::scale(self, extent)
    }

    fn flexibility(&self, _: usize, t: f64) -> f64 {
        Smooth::flexibility(self, t)
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        if let Some(bound) = self.curvature_bound(motion) {
            return bound;
        }
        let mut largest = 0.0_f64;
        with_particles(self, |particles| {
            for row in 0..Smooth::row_count(self, D) {
                // The largest sum over a column bounds the norm.
                let (mut sum, mut last) = (0.0, (0, 0));
                second_derivatives(self, particles, row, motion, &mut |j, k, _, column| {
                    if (j, k) != last {
                        (sum, last) = (0.0, (j, k));
                    }
                    sum += column.iter().map(|entry| entry.abs()).sum::<f64>();
                    largest = largest.max(sum);
                });
            }
        });
        largest
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        with_particles(self, |particles| {
            for (row, multiplier) in lambda.iter().enumerate() {
                second_derivatives(self, particles, row, motion, &mut |j, k, i, column| {
                    if i <= j {
                        let mut block: Block<D> = zero();
                        for (line, entry) in block.iter_mut().zip(column) {
                            line[k] = -multiplier * entry;
                        }
                        visit(i, j, Stiffness::Indefinite(block));
                    }
                });
            }
        });
    }

    fn may_jump(&self) -> bool {
        Smooth::may_jump(self)
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        Smooth::arms(self)
    }

    fn least_size(&self, t: f64) -> f64 {
        Smooth::least_size(self, t)
    }

    fn formulated(&self, _: Formulation) -> Self {
        self.clone()
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        Smooth::fits(self, dimension)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        Smooth::check(self)
    }
}
