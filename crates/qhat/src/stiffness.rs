//! Stiffness −∂Q/∂q of one constraint or force, block by block, so that a method can leave out blocks that may be
//! negative.

use crate::linalg::block::{Block, transposed};
use crate::space::ParticleId;

/// The stiffness [N/m] between two particles i and j; with i = j that of one particle on itself.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stiffness<const D: usize> {
    /// Stiffness of a force that depends on x_i − x_j alone: B on ii and on jj, −B on ij and on ji. With i = j, of a
    /// force that depends on x_i alone. B is semidefinite, of either sign.
    Difference(Block<D>),
    /// Row i, column j, with the transpose implied: one block of a positive semidefinite matrix whose blocks all come.
    Definite(Block<D>),
    /// Row i, column j of a matrix whose sign is not known.
    Indefinite(Block<D>),
}

impl<const D: usize> Stiffness<D> {
    /// Calls `visit(row, column, block)` with every block of it, of the particles i and j.
    #[inline(always)]
    pub(crate) fn blocks(
        &self,
        (i, j): (ParticleId, ParticleId),
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>),
    ) {
        match self {
            Stiffness::Difference(block) => {
                visit(i, i, *block);
                if i != j {
                    let other = block.map(|row| row.map(|entry| -entry));
                    visit(j, j, *block);
                    visit(i, j, other);
                    visit(j, i, other);
                }
            }
            Stiffness::Definite(block) | Stiffness::Indefinite(block) => {
                visit(i, j, *block);
                if i != j {
                    visit(j, i, transposed(block));
                }
            }
        }
    }

    /// factor times it, for a factor that is not negative.
    pub(crate) fn scaled(self, factor: f64) -> Self {
        let scaled = |block: Block<D>| block.map(|row| row.map(|entry| factor * entry));
        match self {
            Stiffness::Difference(block) => Stiffness::Difference(scaled(block)),
            Stiffness::Definite(block) => Stiffness::Definite(scaled(block)),
            Stiffness::Indefinite(block) => Stiffness::Indefinite(scaled(block)),
        }
    }
}

#[cfg(test)]
impl<const D: usize> Stiffness<D> {
    /// Adds all blocks that the stiffness between i and j stands for to a dense matrix.
    pub(crate) fn add_to(&self, dense: &mut [Vec<f64>], i: ParticleId, j: ParticleId) {
        self.blocks((i, j), &mut |row, column, block| {
            for (k, numbers) in block.iter().enumerate() {
                for (l, entry) in numbers.iter().enumerate() {
                    dense[row.0 * D + k][column.0 * D + l] += entry;
                }
            }
        });
    }
}
