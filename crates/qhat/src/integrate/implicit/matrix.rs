//! The matrix of one Newton iteration and its factor.
//!
//! ```text
//! M + h_e² K   Jᵀ        Δq        r            K = −∂Q/∂q − (1/h_e) ∂Q/∂q̇ − Σ λ ∂²C/∂q²
//! J           −E     ·  −Δμ   =   s            E = α/(h_e² (1 + α c/h_e)) for a row of compliance α and damping c
//! ```
//!
//! Rows that are not eliminated with a particle act through a penalty, E + ε instead of E: eliminating Δμ leaves
//! M + h_e² K + Jᵀ (E + ε)⁻¹ J, positive definite wherever the step has a minimum, whatever rows repeat each other. As the
//! residual of every iteration is the true one, ε changes the path and not the place where Newton's method arrives (the
//! proximal method of multipliers): a row whose own E is σ comes nearer by ε/(σ + ε) an iteration.

use super::graph::{BlockSlot, Graph};
use crate::constraint::{Holds, Rows};
use crate::force::Acts;
use crate::linalg::block::{Block, accumulate, diagonal, outer, store, transposed, vector};
use crate::linalg::{NONE, Saddle};
use crate::point::{Motion, dot};
use crate::stiffness::Stiffness;
use crate::system::System;

/// ε of a row, relative to Σ |g|²/(stiffness of the particle): small enough to gain eight digits an iteration, large enough to
/// leave as many in the sums.
const PENALTY: f64 = 1e-8;

/// Passes of a solve: where rows depend on each other but for little, each gains one digit or two.
const PASSES: usize = 6;

/// Where passes have done enough for an iteration of Newton's method.
const SOLVED: f64 = 1e-6;

/// Blocks and factors.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub(super) graph: Graph,
    pub(super) diagonal: Vec<f64>,
    pub(super) coupling: Vec<f64>,
    retreat: Vec<f64>,
    /// m of each node, and m + h_e² |K| as one number.
    mass: Vec<f64>,
    size: Vec<f64>,
    softness: Vec<f64>,
    /// For each penalty row its 1/(E + ε) and its gradient when it was factored, entry by entry.
    weight: Vec<f64>,
    gradient: Vec<f64>,
    /// ε of each penalty row, and what a pass adds to Δq and to −Δμ.
    epsilon: Vec<f64>,
    dr: Vec<f64>,
    ds: Vec<f64>,
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
            softness: vec![0.0; system.row_count()],
            weight: vec![0.0; graph.penalties.len()],
            epsilon: vec![0.0; graph.penalties.len()],
            dr: vec![0.0; nodes * d],
            ds: vec![0.0; system.row_count()],
            gradient: vec![0.0; system.layout.particle.len() * d],
            factorizations: 0,
            graph,
        }
    }

    /// Assembles and factors, for μ = h_e² λ. Where a component with cycles is not positive definite, it is done again without
    /// what is negative in K; false where that does not help either.
    pub(super) fn factor<const D: usize>(
        &mut self,
        system: &System,
        rows: &Rows,
        motion: Motion<'_, D>,
        mu: &[f64],
        h_e: f64,
    ) -> bool {
        [true, false].into_iter().any(|signed| {
            self.assemble(system, rows, motion, mu, h_e, signed);
            self.eliminate::<D>(rows)
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

    fn assemble<const D: usize>(
        &mut self,
        system: &System,
        rows: &Rows,
        motion: Motion<'_, D>,
        mu: &[f64],
        h_e: f64,
        signed: bool,
    ) {
        for (node, &mass) in self.mass.iter().enumerate() {
            store(&mut self.diagonal, node, diagonal::<D>(mass));
        }
        self.size.copy_from_slice(&self.mass);
        self.coupling.fill(0.0);
        self.retreat.fill(0.0);
        for (softness, row) in self.softness.iter_mut().zip(&system.softness) {
            *softness = row.compliance / (h_e * h_e * row.lag(h_e));
        }
        self.add_geometric_stiffness(system, motion, mu, signed);
        self.add_tangents(system, motion, h_e, signed);
        self.add_penalties::<D>(system, rows);
    }

    /// h_e² K of the constraints: −μ ∂²C/∂q².
    fn add_geometric_stiffness<const D: usize>(
        &mut self,
        system: &System,
        motion: Motion<'_, D>,
        mu: &[f64],
        signed: bool,
    ) {
        for (k, named) in system.constraints.iter().enumerate() {
            let multipliers = &mu[named.first_row..named.first_row + named.constraint.row_count(D)];
            named.constraint.geometric_stiffness(motion, multipliers, &mut |i, j, stiffness| {
                self.add(self.graph.own_place(k, i, j), &stiffness, signed);
            });
        }
    }

    /// h_e² (−∂Q/∂q − (1/h_e) ∂Q/∂q̇).
    fn add_tangents<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>, h_e: f64, signed: bool) {
        let weight = h_e * h_e;
        for force in &system.forces {
            force.tangent::<D>(motion, 1.0 / h_e, &mut |a, b, stiffness| {
                self.add(self.graph.place(a, b), &stiffness.scaled(weight), signed);
            });
        }
    }

    /// Adds what it may: all if `signed`, else what is known to be positive.
    #[inline(always)]
    pub(super) fn add<const D: usize>(&mut self, place: BlockSlot, stiffness: &Stiffness<D>, signed: bool) {
        match stiffness {
            Stiffness::Difference(block) => self.add_difference(place, block, signed),
            Stiffness::Definite(block) => self.add_block(place, block),
            Stiffness::Indefinite(block) if signed => self.add_block(place, block),
            // Nothing is positive semidefinite, too: Newton's method goes downhill without it, if slower.
            Stiffness::Indefinite(_) => {}
        }
    }

    /// One block of any matrix.
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

    /// Adds a semidefinite block to the nodes it touches and takes it from between them.
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
    fn add_penalties<const D: usize>(&mut self, system: &System, rows: &Rows) {
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
            // A row without a gradient here weighs nothing, whatever its weight.
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

    /// r ← Δq (D numbers a node) and s ← −Δμ (one number a row). Where rows act through a penalty the first pass leaves ε Δμ
    /// of them; further passes, each no more than a solve with the same factor, take that out.
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
            // In a null space of Jᵀ nothing gets smaller, and nothing that is added there moves anything.
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

    /// The largest change of a multiplier that acts through a penalty, in units of what its penalty makes of it.
    fn largest(&self, s: &[f64]) -> f64 {
        let rows = self.graph.penalties.iter().zip(&self.epsilon);
        rows.map(|(&row, epsilon)| (epsilon * s[row]).abs()).fold(0.0, f64::max)
    }

    /// What a pass with the result s has left of the right sides: −ε s, and nothing of rows without a penalty.
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
