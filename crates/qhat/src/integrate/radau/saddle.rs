//! The matrix of the Newton iterations of a step.
//!
//! ```text
//! M + B/κ + K/κ²   Jᵀ        κ = γ/h, and (α − i β)/h (`tableau.rs`)
//! J + J̇/κ          0         J̇ = ∂(J q̇)/∂q = q̇ᵀ ∂²C/∂q²
//!                            B = −∂Q/∂q̇,   K = −∂Q/∂q − Σ λ ∂²C/∂q²
//! ```
//!
//! ∂C_t/∂q, which few drives have, is left out: Newton's method converges without it.
//!
//! The unknowns are the d velocities of each particle that can move (a *node*), then one multiplier for each rigid row
//! that has a node. Nodes are eliminated in an order of little fill, each row directly after the last of its nodes:
//! then no pivot vanishes where M + B/κ + K/κ² is definite and rows are independent (`linalg/lu.rs`). Rows that depend
//! on each other leave a pivot of zero whatever J̇ is, since their columns Jᵀ depend on each other.

use crate::constraint::{Holds, Rows};
use crate::force::Acts;
use crate::linalg::block::{accumulate, times, vector};
use crate::linalg::{EliminationPlan, Incidence, LuPlan, NONE, Scalar, Unknown};
use crate::point::{Motion, add, dot};
use crate::space::ParticleId;
use crate::system::System;

/// Entries of U of one factor beyond which the method refuses a system: L and U in real and in complex numbers, with
/// their indices, then take 1 GiB.
const MOST_ENTRIES: usize = 16 << 20;

/// The structure of the matrix, and its numbers but for κ.
#[derive(Clone, Debug)]
pub(super) struct Saddle {
    dimension: usize,
    /// The particle of each node, and its mass [kg].
    pub(super) particle: Vec<ParticleId>,
    pub(super) mass: Vec<f64>,
    /// The node of each particle, or [`NONE`].
    node: Vec<usize>,
    /// The rows of unknowns: `rows[i]` has the unknown d·nodes + i.
    pub(super) rows: Vec<usize>,
    /// The nodes that each node is coupled with, ascending: `near[near_start[i]..near_start[i + 1]]`.
    near_start: Vec<usize>,
    near: Vec<usize>,
    /// The entries of J on each node: (unknown of the row, entry).
    gradients_start: Vec<usize>,
    gradients: Vec<(usize, usize)>,
    /// The entries of J of each row of `rows`: (node, entry).
    touched: Vec<Vec<(usize, usize)>>,
    pub(super) plan: LuPlan,
    /// For each row of `rows` whether it follows from others and is left out.
    dependent: Vec<bool>,
    /// K and B: the blocks of the nodes, then one for each entry of `near`.
    by_position: Vec<f64>,
    by_velocity: Vec<f64>,
    gradient: Vec<f64>,
    /// J̇, entry by entry as J.
    turning: Vec<f64>,
}

impl Saddle {
    /// `None` if a factor would not fit into memory.
    pub(super) fn new(system: &System) -> Option<Self> {
        let dimension = system.dimension();
        let particle: Vec<ParticleId> = system.particles().filter(|&id| !system.is_fixed(id)).collect();
        let nodes = particle.len();
        let mut node = vec![NONE; system.particle_count()];
        for (i, id) in particle.iter().enumerate() {
            node[id.0] = i;
        }
        // Particles that a constraint or a force couples.
        let together = |ids: Vec<ParticleId>| -> Vec<usize> {
            let mut nodes: Vec<usize> = ids.iter().map(|id| node[id.0]).filter(|&i| i != NONE).collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        let constraints = system.constraints.iter().map(|named| named.constraint.particles());
        let cliques: Vec<Vec<usize>> =
            constraints.chain(system.all_forces().map(Acts::particles)).map(together).filter(|c| c.len() > 1).collect();
        // Before lists of pairs are made: a clique of k particles is at least k²/2 blocks of U.
        let blocks: usize = cliques.iter().map(|clique| clique.len() * clique.len() / 2).sum();
        if blocks * dimension * dimension > MOST_ENTRIES {
            return None;
        }
        let mut near: Vec<Vec<usize>> = vec![Vec::new(); nodes];
        let mut points: Vec<Vec<u32>> = vec![Vec::new(); nodes];
        for (point, clique) in cliques.iter().enumerate() {
            for &a in clique {
                near[a].extend(clique.iter().filter(|&&b| b != a));
                points[a].push(point as u32);
            }
        }
        near.iter_mut().for_each(|list| {
            list.sort_unstable();
            list.dedup();
        });
        let layout = &system.layout;
        let on_nodes = |row: usize| {
            let entries = layout.start[row]..layout.start[row + 1];
            entries.map(|entry| (node[layout.particle[entry].0], entry)).filter(|&(node, _)| node != NONE)
        };
        let acts = |&row: &usize| system.is_rigid(row) && on_nodes(row).next().is_some();
        let rows: Vec<usize> = (0..system.all_row_count()).filter(acts).collect();
        let touched: Vec<Vec<(usize, usize)>> = rows.iter().map(|&row| on_nodes(row).collect()).collect();
        let mut gradients: Vec<Vec<(usize, usize)>> = vec![Vec::new(); nodes];
        for (i, entries) in touched.iter().enumerate() {
            entries.iter().for_each(|&(node, entry)| gradients[node].push((nodes * dimension + i, entry)));
        }
        let incidence = Incidence::new(cliques.len(), points.into_iter());
        let order = order(&EliminationPlan::new(&incidence).order, &touched, dimension);
        let couplings = couplings(&near, &touched, dimension);
        let plan = LuPlan::new(order, couplings, MOST_ENTRIES)?;
        let (near_start, near) = flattened(near);
        let (gradients_start, gradients) = flattened(gradients);
        let blocks = (nodes + near.len()) * dimension * dimension;
        Some(Saddle {
            dimension,
            mass: particle.iter().map(|id| system.mass[id.0]).collect(),
            particle,
            node,
            dependent: vec![false; rows.len()],
            rows,
            near_start,
            near,
            gradients_start,
            gradients,
            touched,
            by_position: vec![0.0; blocks],
            by_velocity: vec![0.0; blocks],
            gradient: vec![0.0; layout.particle.len() * dimension],
            turning: vec![0.0; layout.particle.len() * dimension],
            plan,
        })
    }

    /// Leaves out the rows that follow from others, which are given in ascending order.
    pub(super) fn leave_out(&mut self, dependent: &[u32]) {
        for (is_dependent, &row) in self.dependent.iter_mut().zip(&self.rows) {
            *is_dependent = dependent.binary_search(&(row as u32)).is_ok();
        }
    }

    /// The knowledge of the pivot of the unknown that is eliminated k-th.
    pub(super) fn kind(&self, k: usize) -> Unknown {
        match (self.plan.order[k] as usize).checked_sub(self.velocities()) {
            None => Unknown::Kept,
            Some(row) if self.dependent[row] => Unknown::LeftOut,
            Some(_) => Unknown::MayDepend,
        }
    }

    /// The number of unknowns: velocities and multipliers.
    pub(super) fn unknowns(&self) -> usize {
        self.plan.unknowns()
    }

    /// The number of velocities among the unknowns.
    pub(super) fn velocities(&self) -> usize {
        self.particle.len() * self.dimension
    }

    /// The entries of J of the i-th row of unknowns: (node, entry).
    pub(super) fn touched(&self, i: usize) -> &[(usize, usize)] {
        &self.touched[i]
    }

    /// Writes K, B, J and J̇ at a motion with these multipliers, one for each row of the system.
    pub(super) fn linearize<const D: usize>(
        &mut self,
        system: &System,
        motion: Motion<'_, D>,
        rows: &Rows,
        lambda: &[f64],
    ) {
        self.by_position.fill(0.0);
        self.by_velocity.fill(0.0);
        self.gradient.copy_from_slice(&rows.J.blocks);
        self.turning.fill(0.0);
        for force in system.all_forces() {
            force.linearize::<D>(motion, &mut |i, j, position, velocity| {
                let slot = self.slot(i, j);
                if slot != NONE {
                    accumulate(&mut self.by_position, slot, 1.0, &position);
                    accumulate(&mut self.by_velocity, slot, 1.0, &velocity);
                }
            });
        }
        for named in &system.constraints {
            let own = named.first_row..named.first_row + named.constraint.row_count(D);
            // A row that gives way is among the forces.
            if own.is_empty() || !system.is_rigid(own.start) {
                continue;
            }
            let particles = named.constraint.particles();
            let mut only = vec![0.0; own.len()];
            for (k, row) in own.enumerate() {
                // −∂²C/∂q² of this row alone, by places in `particles`.
                only[k] = 1.0;
                named.constraint.geometric_stiffness(motion, &only, &mut |i, j, stiffness| {
                    stiffness.blocks((ParticleId(i), ParticleId(j)), &mut |i, j, block| {
                        let slot = self.slot(particles[i.0], particles[j.0]);
                        if slot != NONE {
                            accumulate(&mut self.by_position, slot, lambda[row], &block);
                        }
                        let entry = system.layout.start[row] + i.0;
                        let change = times(&block, motion.v(particles[j.0]));
                        for (turning, change) in self.turning[entry * D..][..D].iter_mut().zip(change) {
                            *turning -= change;
                        }
                    });
                });
                only[k] = 0.0;
            }
        }
    }

    /// The place of the block of two particles, or [`NONE`].
    fn slot(&self, i: ParticleId, j: ParticleId) -> usize {
        let (a, b) = (self.node[i.0], self.node[j.0]);
        if a == NONE || b == NONE {
            return NONE;
        }
        if a == b {
            return a;
        }
        let near = &self.near[self.near_start[a]..self.near_start[a + 1]];
        near.binary_search(&b).map_or(NONE, |place| self.particle.len() + self.near_start[a] + place)
    }

    /// Adds the k-th row, in the order of elimination, to x; u is 1/κ.
    pub(super) fn write<const D: usize, S: Scalar>(&self, k: usize, u: S, x: &mut [S]) {
        let (unknown, nodes) = (self.plan.order[k] as usize, self.particle.len());
        let place = |unknown: usize| self.plan.place[unknown] as usize;
        if unknown >= nodes * D {
            for &(node, entry) in &self.touched[unknown - nodes * D] {
                for c in 0..D {
                    let target = &mut x[place(node * D + c)];
                    *target += S::real(self.gradient[entry * D + c]);
                    *target += u * S::real(self.turning[entry * D + c]);
                }
            }
            return;
        }
        let (i, r) = (unknown / D, unknown % D);
        let (uu, near) = (u * u, self.near_start[i]..self.near_start[i + 1]);
        let own = std::iter::once((i, i));
        for (slot, j) in own.chain(near.map(|e| (nodes + e, self.near[e]))) {
            let at = (slot * D + r) * D;
            for c in 0..D {
                let target = &mut x[place(j * D + c)];
                *target += u * S::real(self.by_velocity[at + c]);
                *target += uu * S::real(self.by_position[at + c]);
            }
        }
        x[k] += S::real(self.mass[i]);
        for &(row, entry) in &self.gradients[self.gradients_start[i]..self.gradients_start[i + 1]] {
            x[place(row)] += S::real(self.gradient[entry * D + r]);
        }
    }

    /// Adds x, a number for each velocity of the nodes, to the numbers of all particles.
    pub(super) fn add_to<const D: usize>(&self, x: &[f64], numbers: &mut [f64]) {
        for (node, &id) in self.particle.iter().enumerate() {
            add(numbers, id, vector::<D>(x, node));
        }
    }

    /// out ← K x over the velocities.
    pub(super) fn stiffness_times<const D: usize>(&self, x: &[f64], out: &mut [f64]) {
        let nodes = self.particle.len();
        for i in 0..nodes {
            let near = self.near_start[i]..self.near_start[i + 1];
            let mut sum = [0.0; D];
            for (slot, j) in std::iter::once((i, i)).chain(near.map(|e| (nodes + e, self.near[e]))) {
                for r in 0..D {
                    for c in 0..D {
                        sum[r] += self.by_position[(slot * D + r) * D + c] * x[j * D + c];
                    }
                }
            }
            out[i * D..][..D].copy_from_slice(&sum);
        }
    }

    /// out ← J̇ x over the rows of unknowns, of x over the velocities.
    pub(super) fn turning_times<const D: usize>(&self, x: &[f64], out: &mut [f64]) {
        for (out, entries) in out.iter_mut().zip(&self.touched) {
            let terms = entries.iter().map(|&(node, e)| dot(vector::<D>(&self.turning, e), vector(x, node)));
            *out = terms.sum();
        }
    }

    /// Whether J vanishes in the i-th row of unknowns.
    pub(super) fn is_zero_row<const D: usize>(&self, i: usize) -> bool {
        self.touched[i].iter().all(|&(_, entry)| vector::<D>(&self.gradient, entry) == [0.0; D])
    }
}

/// The unknowns in the order of elimination: the velocities of each node together, each row directly after the last of
/// its nodes.
fn order(nodes: &[u32], touched: &[Vec<(usize, usize)>], dimension: usize) -> Vec<u32> {
    let mut turn = vec![0; nodes.len()];
    for (k, &node) in nodes.iter().enumerate() {
        turn[node as usize] = k;
    }
    let mut ready: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
    for (i, entries) in touched.iter().enumerate() {
        let last = entries.iter().map(|&(node, _)| turn[node]).max().unwrap_or(0);
        ready[last].push((nodes.len() * dimension + i) as u32);
    }
    let velocities = |node: u32| (0..dimension as u32).map(move |c| node * dimension as u32 + c);
    nodes.iter().zip(ready).flat_map(|(&node, rows)| velocities(node).chain(rows)).collect()
}

/// The pairs of unknowns that have an entry.
fn couplings(
    near: &[Vec<usize>],
    touched: &[Vec<(usize, usize)>],
    dimension: usize,
) -> impl Iterator<Item = (u32, u32)> {
    let velocities = move |node: usize| (node * dimension) as u32..((node + 1) * dimension) as u32;
    let own = (0..near.len())
        .flat_map(move |i| velocities(i).flat_map(move |a| (velocities(i).start..a).map(move |b| (a, b))));
    let others = near.iter().enumerate().flat_map(move |(i, list)| {
        list.iter()
            .filter(move |&&j| j < i)
            .flat_map(move |&j| velocities(i).flat_map(move |a| velocities(j).map(move |b| (a, b))))
    });
    let first = near.len() * dimension;
    let rows = touched.iter().enumerate().flat_map(move |(k, entries)| {
        entries.iter().flat_map(move |&(node, _)| velocities(node).map(move |a| ((first + k) as u32, a)))
    });
    own.chain(others).chain(rows)
}

/// One list after the other, with the start of each.
fn flattened<T>(lists: Vec<Vec<T>>) -> (Vec<usize>, Vec<T>) {
    let mut start = vec![0];
    let mut flat = Vec::new();
    for list in lists {
        flat.extend(list);
        start.push(flat.len());
    }
    (start, flat)
}
