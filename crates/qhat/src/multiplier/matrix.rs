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
use crate::linalg::{Hubs, Incidence, OuterProducts, Pattern, SymmetricMatrix};
use crate::point::{dot, scaled};
use crate::structure::{MatrixStructure, blocks_at};

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

    /// J W Jᵀ with its rows in the order of the user and without unknowns for hubs, for terms. The part of a hub is
    /// kept as outer products: entry by entry it would be as large as the square of its rows.
    pub(crate) fn in_given_order<const D: usize>(&self, J: &Jacobian, W: &[f64]) -> SymmetricMatrix {
        let m = J.row_count();
        let moving = |row: usize| J.row(row).filter(move |(particle, _)| !self.inert[row] && W[particle.0] > 0.0);
        let points = |row: usize| moving(row).map(|(particle, _)| particle.0 as u32);
        let hubs = Hubs::new(&Incidence::new(W.len(), (0..m).map(points)), D);
        let inner = |row: usize| points(row).filter(|&p| hubs.number(p).is_none());
        let incidence = Incidence::new(W.len(), (0..m).map(inner));
        let pattern = Pattern::of_incidence(&incidence);
        let blocks = blocks_at(&incidence, &J.layout, |row| Some(row as usize));
        let mut values = vec![0.0; pattern.len()];
        let weights = hubs.points.iter().flat_map(|&p| [W[p as usize]; D]);
        let mut outer = OuterProducts::new(m, weights.collect());
        // The slot of each column of the row at hand.
        let mut slot_of = vec![0; m];
        for i in 0..m {
            for slot in pattern.start[i]..pattern.start[i + 1] {
                slot_of[pattern.column[slot]] = slot;
            }
            let mut on_hubs: Vec<(usize, f64)> = Vec::new();
            for (particle, numbers) in moving(i) {
                let p = particle.0 as u32;
                if let Some(hub) = hubs.number(p) {
                    on_hubs.extend(numbers.iter().enumerate().map(|(k, &number)| (hub * D + k, number)));
                    continue;
                }
                let left = scaled(W[particle.0], vector::<D>(numbers, 0));
                let others = incidence.unknowns_at(p).iter().zip(&blocks[incidence.first_at(p)..]);
                for (&j, &right) in others.take_while(|&(&j, _)| j as usize <= i) {
                    values[slot_of[j as usize]] += dot(left, J.entry::<D>(right as usize));
                }
            }
            on_hubs.sort_by_key(|&(column, _)| column);
            on_hubs.into_iter().for_each(|(column, number)| outer.push(i, column, number));
        }
        SymmetricMatrix { pattern, values, outer }
    }
}
