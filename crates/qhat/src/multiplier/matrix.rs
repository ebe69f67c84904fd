//! The constraint matrix.
//!
//! ```text
//! A = J W Jᵀ,   A_ij = Σ_p w_p J_ip · J_jp        m × m, symmetric, positive semidefinite
//! ```
//!
//! Two rows are coupled only if they share a particle that can move, so A is as sparse as the graph of rods. Which
//! pairs of blocks meet in which entry is found once, when the System is built, and so is the order of elimination,
//! in which A is stored.
//!
//! A particle h with very many rods, a hub, would couple each of them with every other. Its share of A is not formed;
//! its acceleration stays an unknown of the matrix, in units of √w_h so that all entries are alike in size
//! (`linalg/hubs.rs`):
//!
//! ```text
//! [ A − Σ_h B_h B_hᵀ   B ] [λ]       B_ih = √w_h J_ih,   a_h = B_hᵀ λ
//! [ Bᵀ                −I ] [a]
//! ```

use crate::constraint::Jacobian;
use crate::linalg::block::vector;
use crate::linalg::{Incidence, Pattern, SymmetricMatrix};
use crate::point::{dot, scaled};
use crate::structure::MatrixStructure;

impl MatrixStructure {
    /// Writes A = J W Jᵀ, with hubs in the form above.
    pub(crate) fn assemble<const D: usize>(&self, J: &Jacobian, W: &[f64], A: &mut [f64]) {
        A.fill(0.0);
        let (mut blocks, mut slots) = (&self.blocks[..], &self.slots[..]);
        for meeting in &self.meeting {
            let w = W[meeting.particle.0];
            let (here, rest) = blocks.split_at(meeting.blocks as usize);
            blocks = rest;
            for (k, &left) in here.iter().enumerate() {
                let wJ = scaled(w, J.entry::<D>(left as usize));
                let (row, rest) = slots.split_at(k + 1);
                slots = rest;
                for (&slot, &right) in row.iter().zip(here) {
                    A[slot as usize] += dot(wJ, J.entry::<D>(right as usize));
                }
            }
        }
        for entry in &self.on_hubs {
            A[entry.slot as usize] = W[entry.particle.0].sqrt() * J.blocks[entry.number as usize];
        }
        if !self.on_hubs.is_empty() {
            for (k, &row) in self.order.iter().enumerate() {
                if self.is_hub(row) {
                    A[self.pattern.diagonal(k)] = -1.0;
                }
            }
        }
    }

    /// J W Jᵀ with its rows in the order of the user and without unknowns for hubs, for terms.
    pub(crate) fn in_given_order<const D: usize>(&self, J: &Jacobian, W: &[f64]) -> SymmetricMatrix {
        let m = J.row_count();
        let moving = |row: usize| J.row(row).filter(move |(particle, _)| !self.inert[row] && W[particle.0] > 0.0);
        let incidence = Incidence::new(W.len(), (0..m).map(|row| moving(row).map(|(particle, _)| particle.0 as u32)));
        let pattern = Pattern::of_incidence(&incidence);
        let mut values = vec![0.0; pattern.len()];
        for i in 0..m {
            for slot in pattern.start[i]..pattern.start[i + 1] {
                for (particle, left) in moving(i) {
                    for (_, right) in moving(pattern.column[slot]).filter(|(other, _)| *other == particle) {
                        let (left, right) = (vector::<D>(left, 0), vector::<D>(right, 0));
                        values[slot] += dot(scaled(W[particle.0], left), right);
                    }
                }
            }
        }
        SymmetricMatrix { pattern, values }
    }
}
