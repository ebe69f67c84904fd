//! Stiffness −∂Q/∂q of one constraint or force, block by block, so that a method can leave out blocks that may be
//! negative.

use crate::linalg::block::Block;

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
