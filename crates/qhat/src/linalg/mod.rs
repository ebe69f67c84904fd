//! Symmetric matrices and their LDLᵀ factorization: no physics words, and the only home of speed tricks.
//!
//! Every operation is a plain f64 operation in a fixed order, so native and wasm results agree bit for bit.

pub(crate) mod block;
mod block_ldl;
mod dense;
mod leaf_to_root;
mod ordering;
mod rank;
mod sparse;
mod symmetric;
#[cfg(test)]
mod tests;

pub(crate) use block_ldl::BlockLdl;
pub(crate) use leaf_to_root::{LeafToRoot, Link, NONE, Saddle};
pub(crate) use rank::rank;
pub(crate) use symmetric::Pattern;
pub use symmetric::SymmetricMatrix;

use dense::DenseLdl;
use sparse::SparseLdl;

/// Up to this order the dense factorization is at least as fast as the sparse one, whatever the pattern.
const DENSE_UP_TO: usize = 24;

/// The LDLᵀ factorization of a symmetric positive definite matrix, dense when small, sparse beyond.
#[derive(Clone, Debug)]
pub(crate) enum Factor {
    Dense(DenseLdl),
    Sparse(Box<SparseLdl>),
}

impl Factor {
    /// Chooses the method and prepares everything that depends on the pattern alone.
    pub(crate) fn new(pattern: &Pattern) -> Self {
        if pattern.order() <= DENSE_UP_TO {
            Factor::Dense(DenseLdl::new(pattern.order()))
        } else {
            Factor::Sparse(Box::new(SparseLdl::new(pattern)))
        }
    }

    /// Factors A + shift·I and returns the smallest pivot; a pivot that is not positive means that no factor was made.
    pub(crate) fn factor(&mut self, pattern: &Pattern, values: &[f64], shift: f64) -> f64 {
        match self {
            Factor::Dense(ldl) => ldl.factor(pattern, values, shift),
            Factor::Sparse(ldl) => ldl.factor(values, shift),
        }
    }

    /// x ← (L D Lᵀ)⁻¹ x.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        match self {
            Factor::Dense(ldl) => ldl.solve(x),
            Factor::Sparse(ldl) => ldl.solve(x),
        }
    }
}
