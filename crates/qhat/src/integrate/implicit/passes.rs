//! The solve with the factor of one Newton iteration, in passes that take out the ε of its penalties.

use super::matrix::Matrix;
use crate::linalg::NONE;
use crate::linalg::block::vector;
use crate::point::{dot, larger};
use crate::system::System;

/// Passes of one solve: where rows depend on each other but for little, each gains one digit or two.
const PASSES: usize = 6;

/// Accuracy at which passes have done enough for one iteration of Newton's method.
const SOLVED: f64 = 1e-6;

impl Matrix {
    /// r ← Δq (D numbers a node) and s ← −Δμ (one number a row). Rows that act through a penalty are left with ε Δμ
    /// by the first pass; further passes, each one solve with the same factor, remove it.
    pub(super) fn solve<const D: usize>(&mut self, system: &System, r: &mut [f64], s: &mut [f64]) {
        self.pass::<D>(system, r, s);
        if self.graph.penalties.is_empty() {
            return;
        }
        let (mut dr, mut ds) = (std::mem::take(&mut self.dr), std::mem::take(&mut self.ds));
        ds.copy_from_slice(s);
        let mut last = self.largest(&ds);
        let enough = SOLVED * last;
        for _ in 1..PASSES {
            dr.fill(0.0);
            self.leave(&mut ds);
            self.pass::<D>(system, &mut dr, &mut ds);
            let size = self.largest(&ds);
            // In the null space of Jᵀ the correction does not shrink, and adding it would move nothing.
            if size.is_nan() || size >= 0.5 * last {
                break;
            }
            r.iter_mut().zip(&dr).for_each(|(sum, change)| *sum += change);
            s.iter_mut().zip(&ds).for_each(|(sum, change)| *sum += change);
            last = size;
            if size <= enough {
                break;
            }
        }
        (self.dr, self.ds) = (dr, ds);
    }

    /// One solve of the regularised system.
    fn pass<const D: usize>(&mut self, system: &System, r: &mut [f64], s: &mut [f64]) {
        let Matrix { graph, weight, gradient, .. } = self;
        let on_nodes = |row: usize| {
            let entries = system.layout.start[row]..system.layout.start[row + 1];
            entries.map(|entry| (entry, graph.entry_node[entry])).filter(|&(_, node)| node != NONE)
        };
        for (weight, &row) in weight.iter().zip(&graph.penalties) {
            for (entry, node) in on_nodes(row) {
                for (target, g) in r[node * D..][..D].iter_mut().zip(vector::<D>(gradient, entry)) {
                    *target += weight * s[row] * g;
                }
            }
        }
        graph.forest.solve::<D>(r, s);
        if graph.has_cycles {
            graph.cycles.solve::<D>(r);
        }
        for (weight, &row) in weight.iter().zip(&graph.penalties) {
            let moved: f64 = on_nodes(row).map(|(e, node)| dot(vector::<D>(gradient, e), vector(r, node))).sum();
            s[row] = weight * (moved - s[row]);
        }
    }

    /// The largest change of a multiplier that acts through a penalty, times its ε.
    fn largest(&self, s: &[f64]) -> f64 {
        let rows = self.graph.penalties.iter().zip(&self.epsilon);
        rows.map(|(&row, epsilon)| (epsilon * s[row]).abs()).fold(0.0, larger)
    }

    /// s ← the right-hand side that a pass with the result s has left: −ε s, and zero for rows without a penalty.
    fn leave(&self, s: &mut [f64]) {
        for link in &self.graph.forest.links {
            if link.row != NONE {
                s[link.row] = 0.0;
            }
        }
        for (&row, epsilon) in self.graph.penalties.iter().zip(&self.epsilon) {
            s[row] *= -epsilon;
        }
    }
}
