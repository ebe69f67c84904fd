//! The constraint matrix.
//!
//! ```text
//! A = J W Jᵀ,   A_ij = Σ_p w_p J_ip · J_jp        m × m, symmetric, positive semidefinite
//! ```
//!
//! Two rows are coupled only if they share a particle that can move, so A is as sparse as the graph of rods. Which pairs of
//! blocks meet in which entry is found once, when the System is built.

use crate::constraint::{Jacobian, Layout, Softness};
use crate::linalg::Pattern;
use crate::point::dot;
use crate::system::ParticleId;

/// The structure of A: its pattern and what is summed into each entry.
#[derive(Clone, Debug, Default)]
pub(crate) struct MatrixStructure {
    pub(crate) pattern: Pattern,
    products: Vec<Product>,
    /// Rows all of whose particles are fixed, and rows that give way and are forces here: their row of A is zero for good.
    pub(crate) inert: Vec<bool>,
}

/// values[slot] += w_p J[left] · J[right].
#[derive(Clone, Copy, Debug)]
struct Product {
    slot: usize,
    left: usize,
    right: usize,
    particle: ParticleId,
}

impl MatrixStructure {
    pub(crate) fn new(layout: &Layout, W: &[f64], softness: &[Softness]) -> Self {
        let m = layout.row_count();
        // For every particle that can move: the rows that touch it, with the block of J.
        let mut touching = vec![Vec::new(); W.len()];
        let mut inert = vec![true; m];
        for row in 0..m {
            for e in layout.start[row]..layout.start[row + 1] {
                let particle = layout.particle[e];
                if W[particle.0] > 0.0 && softness[row].is_rigid() {
                    touching[particle.0].push((row, e));
                    inert[row] = false;
                }
            }
        }
        let mut columns = vec![Vec::new(); m];
        let pairs = |entries: &[(usize, usize)], visit: &mut dyn FnMut((usize, usize), (usize, usize))| {
            for (k, &right) in entries.iter().enumerate() {
                for &left in &entries[k..] {
                    visit(left, right);
                }
            }
        };
        for entries in &touching {
            pairs(entries, &mut |left, right| columns[left.0].push(right.0));
        }
        let pattern = Pattern::from_rows(columns);
        let mut products = Vec::new();
        for (particle, entries) in touching.iter().enumerate() {
            pairs(entries, &mut |left, right| {
                if let Some(slot) = pattern.slot(left.0, right.0) {
                    products.push(Product { slot, left: left.1, right: right.1, particle: ParticleId(particle) });
                }
            });
        }
        MatrixStructure { pattern, products, inert }
    }

    /// Writes A = J W Jᵀ.
    pub(crate) fn assemble<const D: usize>(&self, J: &Jacobian, W: &[f64], A: &mut [f64]) {
        A.fill(0.0);
        for product in &self.products {
            A[product.slot] += W[product.particle.0] * dot(J.entry::<D>(product.left), J.entry::<D>(product.right));
        }
    }
}
