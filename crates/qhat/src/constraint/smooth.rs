//! Constraints from C and its gradient alone: everything else follows by carrying a derivative through the same formulas.
//!
//! ```text
//! along (q + τ q̇, t + τ):   J ↦ J + J̇ ε,   C_t ↦ C_t + Ċ_t ε
//! Ċ = J q̇ + C_t
//! γ = J̇ q̇ + Ċ_t            = (∂(J q̇)/∂q) q̇ + J_t q̇ + J_t q̇ + C_tt
//! along coordinate k of particle j:   J_i ↦ J_i + (∂²C/∂x_i ∂x_jk) ε, one column of the geometric stiffness
//! ```
//!
//! So a kind writes its residual and its gradient once, over numbers that may carry a derivative (`number.rs`), and nothing else is
//! derived by hand.

use super::{ConstraintError, Formulation, Holds, RowWriter};
use crate::linalg::block::{Block, zero};
use crate::number::{Dual, Number};
use crate::point::{Motion, dot};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// A constraint whose rows are smooth functions of positions and time.
pub(crate) trait Smooth: Clone {
    /// Number of scalar rows in d dimensions.
    fn row_count(&self, dimension: usize) -> usize;

    /// Whether its rows are the components of a vector.
    fn is_vector(&self) -> bool {
        false
    }

    /// The i-th of the particles it names, each once; `None` after the last.
    fn particle(&self, i: usize) -> Option<ParticleId>;

    /// Hands ∂C/∂x of one row to `gradient`, particle after particle in the order of `particle`, and returns C and C_t. `x` tells
    /// where the i-th of its particles is.
    fn row<N: Number, const D: usize>(
        &self,
        row: usize,
        x: &impl Fn(usize) -> [N; D],
        t: N,
        gradient: &mut impl FnMut([N; D]),
    ) -> (N, N);

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// Why it cannot be in d dimensions, in words.
    fn fits(&self, _dimension: usize) -> Result<(), ConstraintError> {
        Ok(())
    }

    /// What is wrong with its numbers, in words.
    fn check(&self) -> Result<(), ConstraintError>;
}

/// Calls `visit(j, k, i, column)` with ∂²C/∂x_i ∂x_jk of one row.
fn second_derivatives<S: Smooth, const D: usize>(
    constraint: &S,
    row: usize,
    motion: Motion<'_, D>,
    visit: &mut impl FnMut(usize, usize, usize, [f64; D]),
) {
    let particle = |i| constraint.particle(i).expect("one of its particles");
    for j in (0..).take_while(|&j| constraint.particle(j).is_some()) {
        for k in 0..D {
            let x = |i: usize| {
                let mut place = motion.x(particle(i)).map(Dual::constant);
                if i == j {
                    place[k].slope = 1.0;
                }
                place
            };
            let mut i = 0;
            constraint.row::<Dual, D>(row, &x, Dual::constant(motion.t), &mut |gradient| {
                visit(j, k, i, gradient.map(|component| component.slope));
                i += 1;
            });
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
            rows.write_blocks(|particles, write| {
                let x = |i: usize| {
                    let (place, velocity) = (motion.x(particles[i]), motion.v(particles[i]));
                    std::array::from_fn(|k| Dual { value: place[k], slope: velocity[k] })
                };
                let (mut rate, mut gamma, mut i) = (0.0, 0.0, 0);
                let t = Dual { value: motion.t, slope: 1.0 };
                let (C, Ct) = self.row::<Dual, D>(row, &x, t, &mut |gradient| {
                    let v = motion.v(particles[i]);
                    let block = gradient.map(|component| component.value);
                    rate += dot(block, v);
                    gamma += dot(gradient.map(|component| component.slope), v);
                    write(block);
                    i += 1;
                });
                [C.value, rate + Ct.value, gamma + Ct.slope, Ct.value]
            });
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        Smooth::scale(self, extent)
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let mut largest = 0.0_f64;
        for row in 0..Smooth::row_count(self, D) {
            // The largest sum over a column bounds the norm.
            let (mut sum, mut last) = (0.0, (0, 0));
            second_derivatives(self, row, motion, &mut |j, k, _, column| {
                if (j, k) != last {
                    (sum, last) = (0.0, (j, k));
                }
                sum += column.iter().map(|entry| entry.abs()).sum::<f64>();
                largest = largest.max(sum);
            });
        }
        largest
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        for (row, multiplier) in lambda.iter().enumerate() {
            second_derivatives(self, row, motion, &mut |j, k, i, column| {
                if i <= j {
                    let mut block: Block<D> = zero();
                    for (line, entry) in block.iter_mut().zip(column) {
                        line[k] = -multiplier * entry;
                    }
                    visit(i, j, Stiffness::Indefinite(block));
                }
            });
        }
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
