//! The matrix of one Newton iteration and its factor.
//!
//! ```text
//! M + h_e² K   Jᵀ        Δq        r            K = −∂Q/∂q − (1/h_e) ∂Q/∂q̇ − Σ λ ∂²C/∂q²
//! J           −E     ·  −Δμ   =   s            E = α/(h_e² (1 + α c/h_e)) for a row of compliance α and damping c
//! ```
//!
//! Rows that are not eliminated with a particle act through a penalty, E + ε instead of E. Eliminating Δμ leaves
//!
//! ```text
//! M + h_e² K + Jᵀ (E + ε)⁻¹ J
//! ```
//!
//! which is positive definite wherever the step has a minimum, also with redundant rows. The residual of every
//! iteration is the true one, so ε changes the path of Newton's method and not its limit (the proximal method of
//! multipliers): a row whose own E is σ comes nearer by ε/(σ + ε) an iteration.
//!
//! `graph.rs` says where each block is, `stiffness.rs` adds K and the penalties, `passes.rs` solves.

use super::graph::Graph;
use crate::constraint::Rows;
use crate::linalg::Saddle;
use crate::linalg::block::{diagonal, store};
use crate::point::Motion;
use crate::system::System;

/// E of a row that does not act: whatever its C, its multiplier stays zero to roundoff.
const YIELDING: f64 = 1e200;

/// The motion and the multipliers with which the matrix is assembled.
#[derive(Clone, Copy)]
pub(super) struct Linearization<'a, const D: usize> {
    pub(super) system: &'a System,
    /// The rows, evaluated at the motion.
    pub(super) rows: &'a Rows,
    pub(super) motion: Motion<'a, D>,
    /// μ = h_e² λ.
    pub(super) mu: &'a [f64],
    pub(super) h_e: f64,
    /// Rows that follow from others: they do not act.
    pub(super) dependent: &'a [u32],
}

/// The matrix by blocks, and its factor.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub(super) graph: Graph,
    pub(super) diagonal: Vec<f64>,
    pub(super) coupling: Vec<f64>,
    /// The indefinite part of the coupling, which `linalg/leaf_to_root.rs` may take out.
    pub(super) retreat: Vec<f64>,
    /// m of each node, and m + h_e² |K| as one number.
    mass: Vec<f64>,
    pub(super) size: Vec<f64>,
    /// E of each row.
    pub(super) softness: Vec<f64>,
    /// For each penalty row its 1/(E + ε), and its gradient when it was factored, entry by entry.
    pub(super) weight: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    /// ε of each penalty row, and what a pass adds to Δq and to −Δμ.
    pub(super) epsilon: Vec<f64>,
    pub(super) dr: Vec<f64>,
    pub(super) ds: Vec<f64>,
    pub(super) factorizations: usize,
}

impl Matrix {
    pub(super) fn new(system: &System) -> Self {
        let graph = Graph::new(system);
        let (d, nodes, edges) = (system.dimension(), graph.particle.len(), graph.edges.len());
        Matrix {
            diagonal: vec![0.0; nodes * d * d],
            coupling: vec![0.0; edges * d * d],
            retreat: vec![0.0; edges * d * d],
            mass: graph.particle.iter().map(|id| system.mass[id.0]).collect(),
            size: vec![0.0; nodes],
            softness: vec![0.0; system.all_row_count()],
            weight: vec![0.0; graph.penalties.len()],
            epsilon: vec![0.0; graph.penalties.len()],
            dr: vec![0.0; nodes * d],
            ds: vec![0.0; system.all_row_count()],
            gradient: vec![0.0; system.layout.particle.len() * d],
            factorizations: 0,
            graph,
        }
    }

    /// Assembles and factors. If a component with cycles is not positive definite, once more without the negative
    /// part of K; false if it is not definite then either.
    pub(super) fn factor<const D: usize>(&mut self, at: &Linearization<'_, D>) -> bool {
        [true, false].into_iter().any(|signed| {
            self.assemble(at, signed);
            self.eliminate::<D>(at.rows)
        })
    }

    fn eliminate<const D: usize>(&mut self, rows: &Rows) -> bool {
        self.factorizations += 1;
        let Matrix { graph, diagonal, coupling, retreat, mass, softness, .. } = self;
        let is_definite = !graph.has_cycles || graph.cycles.factor::<D>(diagonal, coupling, mass);
        if is_definite {
            let rows = &rows.J.blocks;
            graph.forest.factor::<D>(Saddle { diagonal, coupling, retreat, floor: mass, rows, softness });
        }
        is_definite
    }

    fn assemble<const D: usize>(&mut self, at: &Linearization<'_, D>, signed: bool) {
        let Linearization { system, rows, h_e, dependent, .. } = *at;
        for (node, &mass) in self.mass.iter().enumerate() {
            store(&mut self.diagonal, node, diagonal::<D>(mass));
        }
        self.size.copy_from_slice(&self.mass);
        self.coupling.fill(0.0);
        self.retreat.fill(0.0);
        for (softness, row) in self.softness.iter_mut().zip(&system.softness) {
            *softness = row.compliance / (h_e * h_e * row.lag(h_e));
        }
        for &row in dependent {
            self.softness[row as usize] = YIELDING;
        }
        self.add_geometric_stiffness(at, signed);
        self.add_tangents(at, signed);
        self.add_penalties::<D>(system, rows);
    }
}
