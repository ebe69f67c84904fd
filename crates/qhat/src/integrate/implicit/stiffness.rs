//! The entries of the matrix of one Newton iteration: stiffness of constraints and forces, and penalties.

use super::graph::BlockSlot;
use super::matrix::{Linearization, Matrix};
use crate::constraint::{Holds, Rows};
use crate::force::Acts;
use crate::linalg::NONE;
use crate::linalg::block::{Block, accumulate, outer, transposed, vector};
use crate::point::dot;
use crate::stiffness::Stiffness;
use crate::system::System;

/// ε of a row, relative to Σ |g|²/(stiffness of the particle): small enough to gain eight digits an iteration, large
/// enough to leave as many in the sums.
const PENALTY: f64 = 1e-8;

impl Matrix {
    /// h_e² K of constraints: −μ ∂²C/∂q².
    pub(super) fn add_geometric_stiffness<const D: usize>(&mut self, at: &Linearization<'_, D>, signed: bool) {
        let Linearization { system, rows, motion, mu, .. } = *at;
        for (k, named) in system.constraints.iter().enumerate() {
            let multipliers = &mu[named.first_row..named.first_row + named.constraint.row_count(D)];
            let mut add = |i, j, stiffness| self.add(self.graph.own_place(k, i, j), &stiffness, signed);
            match rows.feet.bead(&named.constraint, named.first_row, motion.t) {
                Some(bead) => bead.geometric_stiffness(motion, multipliers, &mut add),
                None => named.constraint.geometric_stiffness(motion, multipliers, &mut add),
            }
        }
    }

    /// h_e² K of forces: h_e² (−∂Q/∂q − (1/h_e) ∂Q/∂q̇).
    pub(super) fn add_tangents<const D: usize>(&mut self, at: &Linearization<'_, D>, signed: bool) {
        let Linearization { system, motion, h_e, .. } = *at;
        let weight = h_e * h_e;
        for force in &system.forces {
            force.tangent::<D>(motion, 1.0 / h_e, &mut |a, b, stiffness| {
                self.add(self.graph.place(a, b), &stiffness.scaled(weight), signed);
            });
        }
    }

    /// Adds a stiffness: all of it if `signed`, else the part that is known to be positive semidefinite.
    #[inline(always)]
    pub(super) fn add<const D: usize>(&mut self, place: BlockSlot, stiffness: &Stiffness<D>, signed: bool) {
        match stiffness {
            Stiffness::Difference(block) => self.add_difference(place, block, signed),
            Stiffness::Definite(block) => self.add_block(place, block),
            Stiffness::Indefinite(block) if signed => self.add_block(place, block),
            // Without such a block the method still goes downhill, if slower.
            Stiffness::Indefinite(_) => {}
        }
    }

    /// Adds one block of any matrix.
    fn add_block<const D: usize>(&mut self, place: BlockSlot, block: &Block<D>) {
        if place.a == place.b {
            if place.a != NONE {
                accumulate(&mut self.diagonal, place.a, 1.0, block);
                self.size[place.a] += (0..D).map(|k| block[k][k].abs()).sum::<f64>();
            }
        } else if place.edge != NONE {
            let is_turned = self.graph.edges[place.edge] != (place.a, place.b);
            let block = if is_turned { transposed(block) } else { *block };
            accumulate(&mut self.coupling, place.edge, 1.0, &block);
        }
    }

    /// Adds a semidefinite block to the diagonal of its two nodes, and subtracts it from their coupling.
    #[inline(always)]
    fn add_difference<const D: usize>(&mut self, place: BlockSlot, block: &Block<D>, signed: bool) {
        let trace: f64 = (0..D).map(|k| block[k][k]).sum();
        if trace < 0.0 && !signed {
            return;
        }
        if place.a != NONE {
            accumulate(&mut self.diagonal, place.a, 1.0, block);
            self.size[place.a] += trace.abs();
        }
        if place.b != NONE && place.b != place.a {
            accumulate(&mut self.diagonal, place.b, 1.0, block);
            self.size[place.b] += trace.abs();
        }
        if place.edge != NONE {
            accumulate(&mut self.coupling, place.edge, -1.0, block);
            if trace < 0.0 {
                accumulate(&mut self.retreat, place.edge, 1.0, block);
            }
        }
    }

    /// Jᵀ (E + ε)⁻¹ J of the rows that are not eliminated with a particle.
    pub(super) fn add_penalties<const D: usize>(&mut self, system: &System, rows: &Rows) {
        let Matrix { graph, diagonal, coupling, size, softness, weight, epsilon, gradient, .. } = self;
        for ((weight, epsilon), &row) in weight.iter_mut().zip(epsilon).zip(&graph.penalties) {
            let entries = system.layout.start[row]..system.layout.start[row + 1];
            let on_nodes = entries.filter(|&entry| graph.entry_node[entry] != NONE);
            let mut mobility = 0.0;
            for entry in on_nodes.clone() {
                let g = rows.J.entry::<D>(entry);
                gradient[entry * D..][..D].copy_from_slice(&g);
                mobility += dot(g, g) / size[graph.entry_node[entry]];
            }
            // A row without a gradient here adds nothing.
            *epsilon = PENALTY * mobility;
            *weight = if mobility > 0.0 { 1.0 / (softness[row] + *epsilon) } else { 0.0 };
            for first in on_nodes.clone() {
                let (a, g) = (graph.entry_node[first], vector::<D>(gradient, first));
                accumulate(diagonal, a, *weight, &outer(1.0, g, g));
                for second in on_nodes.clone().filter(|&second| second > first) {
                    let (b, other) = (graph.entry_node[second], vector::<D>(gradient, second));
                    let edge = graph.find(a, b);
                    let (above, beside) = if graph.edges[edge] == (a, b) { (g, other) } else { (other, g) };
                    accumulate(coupling, edge, *weight, &outer(1.0, above, beside));
                }
            }
        }
    }
}
