//! The graph of a system: particles that can move as nodes, rows and springs as edges. Found once for a system.
//!
//! The graph falls into components at the fixed particles. A component without cycles is eliminated from its leaves
//! to its root, each rod with the particle below it. Rows that remain there (a second rod beside the first, the other
//! end of a cable), and every row of a component with cycles, act through a penalty, which only adds to blocks that
//! exist anyway.

use crate::constraint::Holds;
use crate::error::StepError;
use crate::force::Acts;
use crate::linalg::{BlockLdl, ForestEdge, LeafToRoot, NONE};
use crate::space::ParticleId;
use crate::system::System;

/// The slot of a block: the nodes of its row and column, the same on the diagonal, and the edge between them. Each
/// may be [`NONE`].
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockSlot {
    pub(super) a: usize,
    pub(super) b: usize,
    pub(super) edge: usize,
}

/// The first entry and the first edge of one constraint.
#[derive(Clone, Copy, Debug)]
struct Own {
    /// Among the entries of J: that of its first particle in its first row.
    entry: usize,
    /// Among the edges between two of its particles i < j: that of 0 and 1, the others following in the order 02, 12,
    /// 03, ….
    edge: usize,
}

/// Nodes, edges, and how they are eliminated.
#[derive(Clone, Debug)]
pub(super) struct Graph {
    /// The particle of each node.
    pub(super) particle: Vec<ParticleId>,
    /// The node of each entry of J, or [`NONE`].
    pub(super) entry_node: Vec<usize>,
    /// The node of each particle, or [`NONE`].
    node: Vec<usize>,
    /// The edges with the lower node first, ascending: for finding one.
    sorted: Vec<(usize, usize)>,
    /// (first, second): the block of the edge is H_first,second.
    pub(super) edges: Vec<(usize, usize)>,
    /// For each row whether it lies on no node, or never acts.
    pub(super) idle: Vec<bool>,
    /// Rows that act through a penalty.
    pub(super) penalties: Vec<usize>,
    /// The entries and edges of each constraint.
    constraints: Vec<Own>,
    own_edges: Vec<usize>,
    pub(super) forest: LeafToRoot,
    pub(super) cycles: BlockLdl,
    pub(super) has_cycles: bool,
}

impl Graph {
    pub(super) fn new(system: &System) -> Self {
        let particle: Vec<ParticleId> =
            (0..system.particle_count()).map(ParticleId).filter(|&id| !system.is_fixed(id)).collect();
        let mut node = vec![NONE; system.particle_count()];
        for (i, id) in particle.iter().enumerate() {
            node[id.0] = i;
        }
        let connected = system.constraints.iter().map(|named| named.constraint.particles());
        let connected = connected.chain(system.forces.iter().map(|force| force.particles()));
        let mut sorted: Vec<(usize, usize)> = Vec::new();
        for ids in connected {
            let nodes: Vec<usize> = ids.iter().map(|id| node[id.0]).filter(|&i| i != NONE).collect();
            for (k, &a) in nodes.iter().enumerate() {
                sorted.extend(nodes[k + 1..].iter().map(|&b| (a.min(b), a.max(b))));
            }
        }
        sorted.sort_unstable();
        sorted.dedup();
        let mut graph = Graph {
            entry_node: system.layout.particle.iter().map(|id| node[id.0]).collect(),
            particle,
            node,
            edges: sorted.clone(),
            sorted,
            idle: Vec::new(),
            penalties: Vec::new(),
            constraints: Vec::new(),
            own_edges: Vec::new(),
            forest: LeafToRoot::default(),
            cycles: BlockLdl::default(),
            has_cycles: false,
        };
        for named in &system.constraints {
            let own = Own { entry: system.layout.start[named.first_row], edge: graph.own_edges.len() };
            graph.constraints.push(own);
            let ids = named.constraint.particles();
            for (j, &b) in ids.iter().enumerate() {
                for &a in &ids[..j] {
                    let edge = graph.place(a, b).edge;
                    graph.own_edges.push(edge);
                }
            }
        }
        graph.order_elimination(system);
        graph
    }

    /// The node of a particle, or [`NONE`].
    pub(super) fn node(&self, id: ParticleId) -> usize {
        self.node[id.0]
    }

    /// The slot of the block of two particles, or of one with itself.
    pub(super) fn place(&self, a: ParticleId, b: ParticleId) -> BlockSlot {
        let (a, b) = (self.node(a), self.node(b));
        BlockSlot { a, b, edge: self.find(a, b) }
    }

    /// The same for the i-th and the j-th particle of a constraint, i ≤ j.
    #[inline(always)]
    pub(super) fn own_place(&self, constraint: usize, i: usize, j: usize) -> BlockSlot {
        let Own { entry, edge } = self.constraints[constraint];
        let (a, b) = (self.entry_node[entry + i], self.entry_node[entry + j]);
        BlockSlot { a, b, edge: if i == j { NONE } else { self.own_edges[edge + j * (j - 1) / 2 + i] } }
    }

    pub(super) fn find(&self, a: usize, b: usize) -> usize {
        self.sorted.binary_search(&(a.min(b), a.max(b))).unwrap_or(NONE)
    }

    /// The entries of a row that lie on nodes; none of a row that never acts.
    fn touched(&self, system: &System, row: usize) -> Vec<usize> {
        let entries = system.layout.start[row]..system.layout.start[row + 1];
        let acts = !system.is_following(row);
        entries.filter(|&entry| acts && self.entry_node[entry] != NONE).collect()
    }

    fn order_elimination(&mut self, system: &System) {
        let count = self.particle.len();
        self.idle = (0..system.all_row_count()).map(|row| self.touched(system, row).is_empty()).collect();
        let mut neighbours: Vec<Vec<(usize, usize)>> = vec![Vec::new(); count];
        for (edge, &(a, b)) in self.edges.iter().enumerate() {
            neighbours[a].push((b, edge));
            neighbours[b].push((a, edge));
        }
        // For each edge and each node, the first row that lies on it alone.
        let mut row_of_edge = vec![NONE; self.edges.len()];
        let mut row_of_node = vec![NONE; count];
        let pulling = system.constraints.iter().flat_map(|named| {
            let rows = named.constraint.row_count(system.dimension());
            std::iter::repeat_n(named.constraint.pulls_on_each(), rows)
        });
        let pulls_on_each: Vec<bool> = pulling.collect();
        for row in (0..system.all_row_count()).rev() {
            match self.touched(system, row)[..] {
                [entry] => row_of_node[self.entry_node[entry]] = row,
                // A row without a gradient at the child would be lost with it.
                [a, b] if pulls_on_each[row] => {
                    let edge = self.find(self.entry_node[a], self.entry_node[b]);
                    if edge != NONE {
                        row_of_edge[edge] = row;
                    }
                }
                _ => {}
            }
        }
        let mut eliminated_with = vec![false; system.all_row_count()];
        let mut visited = vec![false; count];
        let (mut links, mut in_cycles) = (Vec::new(), Vec::new());
        // Roots with a row to a fixed particle come first: that row then needs no penalty.
        let anchored = (0..count).filter(|&node| row_of_node[node] != NONE);
        let roots: Vec<usize> = anchored.chain(0..count).collect();
        for root in roots {
            if visited[root] {
                continue;
            }
            let tree = walk(root, &neighbours, &mut visited);
            let edge_ends: usize = tree.iter().map(|&(node, ..)| neighbours[node].len()).sum();
            if edge_ends / 2 != tree.len() - 1 {
                in_cycles.extend(tree.iter().map(|&(node, ..)| node));
                continue;
            }
            for &(node, parent, edge) in &tree {
                let row = if parent == NONE { row_of_node[node] } else { row_of_edge[edge] };
                let (mut own, mut above) = (NONE, NONE);
                if row != NONE {
                    eliminated_with[row] = true;
                    for entry in self.touched(system, row) {
                        if self.entry_node[entry] == node { own = entry } else { above = entry }
                    }
                }
                if parent != NONE {
                    self.edges[edge] = (node, parent);
                }
                links.push(ForestEdge { node, parent, edge, row, own, above });
            }
        }
        links.reverse();
        in_cycles.sort_unstable();
        self.penalties = (0..system.all_row_count()).filter(|&row| !eliminated_with[row] && !self.idle[row]).collect();
        self.has_cycles = !in_cycles.is_empty();
        self.forest = LeafToRoot::new(links, system.dimension());
        self.cycles = BlockLdl::new(&in_cycles, &self.edges, system.dimension());
    }
}

/// The most pairs of particles that constraints and forces may couple. A pair takes about 300 bytes with its block of H
/// and of the factor, so these are 5 GB; a rod has one pair, a rope over 5000 pulleys 12.5 million.
const MOST_COUPLINGS: usize = 1 << 24;

/// Refuses a system whose constraints and forces couple too many pairs of particles for a matrix with a block for each,
/// before anything is allocated.
///
/// # Errors
/// [`StepError::TooManyCouplings`], with the constraint of most particles.
pub(super) fn check_couplings(system: &System, time: f64) -> Result<(), StepError> {
    let moving = |ids: &[ParticleId]| ids.iter().filter(|&&id| !system.is_fixed(id)).count();
    let pairs = |count: usize| count.saturating_mul(count.saturating_sub(1)) / 2;
    let of_forces = system.forces.iter().map(|force| pairs(moving(&force.particles())));
    let first_rows = system.constraints.iter().map(|named| named.first_row);
    let particles =
        first_rows.map(|row| &system.layout.particle[system.layout.start[row]..system.layout.start[row + 1]]);
    let counts: Vec<usize> = particles.map(moving).collect();
    let sum = counts.iter().map(|&count| pairs(count)).chain(of_forces).fold(0, usize::saturating_add);
    if sum <= MOST_COUPLINGS {
        return Ok(());
    }
    let largest = (0..counts.len()).max_by_key(|&place| counts[place]);
    let constraint = largest.map(|place| system.constraints[place].name.clone());
    Err(StepError::TooManyCouplings { time, constraint, pairs: sum, limit: MOST_COUPLINGS })
}

/// The component of a root, parents before children: (node, parent, edge to it).
fn walk(root: usize, neighbours: &[Vec<(usize, usize)>], visited: &mut [bool]) -> Vec<(usize, usize, usize)> {
    let mut found = Vec::new();
    let mut frontier = vec![(root, NONE, NONE)];
    visited[root] = true;
    while let Some((node, parent, edge)) = frontier.pop() {
        found.push((node, parent, edge));
        for &(next, edge) in &neighbours[node] {
            if !visited[next] {
                visited[next] = true;
                frontier.push((next, node, edge));
            }
        }
    }
    found
}
