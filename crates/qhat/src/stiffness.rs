//! Stiffness −∂Q/∂q of one constraint or force, block by block, so that a method may leave out what could be negative.

use crate::linalg::block::Block;

/// The stiffness [N/m] between two particles i and j; with i = j that of one on itself.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stiffness<const D: usize> {
    /// Of what depends on x_i − x_j alone: B on ii and on jj, −B on ij and on ji; with i = j, of what depends on x_i alone. B is
    /// semidefinite, of either sign.
    Difference(Block<D>),
    /// Row i, column j, with the transpose implied: one block of a positive semidefinite matrix that is handed over whole.
    #[cfg_attr(not(test), expect(dead_code, reason = "the first force on three particles will construct it"))]
    Definite(Block<D>),
    /// The same of a matrix whose sign is not known.
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
