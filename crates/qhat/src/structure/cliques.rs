//! Flat cliques: particles whose mutual distances rods hold, and which these lengths keep in one line or, in space, in
//! one plane.
//!
//! ```text
//! line    |ab| + |bc| = |ac|                                    three rods
//! plane   the lengths of six rods leave a tetrahedron no height
//! ```
//!
//! Such rods hold a joint across the line (plane) only to second order: their rows depend on each other, and a force
//! across the line is met by no finite tension. `multiplier/second_order.rs` decides whether other rows hold the joint.
//! The distance of two fixed particles counts as the length of a rod.
//!
//! Triangles are found with each edge directed to the end of higher degree, in O(m^1.5) for m rods, and in O(m) in
//! chains, nets, trusses, stars and wheels. Source: Chiba and Nishizeki, Arboricity and subgraph listing algorithms,
//! SIAM J. Comput. 14 (1985).

use crate::constraint::NamedConstraint;
use crate::point::{block, minus, norm};
use crate::space::{ConstraintId, ParticleId};
use std::collections::BTreeMap;

/// Relative error of lengths that counts as none. Rods hold their lengths to 1e-10, and a scene has its numbers to ten
/// digits or more; at a triangle as flat as this a tension is 1e4 times the load across it.
const TIGHT: f64 = 1e-9;

/// Number of triangles beyond which no planes are sought: 55 particles with every distance held have 26,235.
const TRIANGLES: usize = 200_000;

/// Number of pairs of triangles on one edge beyond which no planes are sought: 55 particles with every distance held
/// have 2 million, which take a fraction of a second.
const PAIRS: usize = 1 << 21;

/// Particles that lie in one line or one plane because of the rods between them: see
/// [`Simulation::second_order`](crate::Simulation::second_order).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FlatClique {
    /// The particles, ascending.
    pub particles: Vec<ParticleId>,
    /// The constraints that are its rods, ascending.
    pub rods: Vec<ConstraintId>,
    /// Whether the particles lie in one line, else in one plane.
    pub is_line: bool,
}

/// One edge of the graph of known distances.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [usize; 2],
    length: f64,
    /// The constraint; `None` between two fixed particles.
    rod: Option<ConstraintId>,
}

/// The flat cliques of the rigid rods that are whole, of a system of d = D dimensions whose fixed particles are at
/// q \[m\]. Those in a line come first.
pub(crate) fn flat_cliques<const D: usize>(
    constraints: &[NamedConstraint],
    inverse_mass: &[f64],
    q: &[f64],
    is_broken: &dyn Fn(usize) -> bool,
) -> Vec<FlatClique> {
    let whole = constraints.iter().enumerate().filter(|&(place, _)| !is_broken(place));
    let edges = edges::<D>(whole, inverse_mass, q);
    let graph = Graph::new(inverse_mass.len(), &edges);
    let mut lines = Classes::new(edges.len());
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    graph.triangles(&edges, &mut |sides| {
        if is_tight(sides.map(|side| edges[side].length)) {
            lines.join(&sides);
        } else if D == 3 && triangles.len() <= TRIANGLES {
            triangles.push(sides.map(|side| side as u32));
        }
    });
    let mut cliques: Vec<FlatClique> = lines.parts().into_iter().map(|part| clique(&edges, &part, true)).collect();
    if D == 3 && triangles.len() <= TRIANGLES {
        let planes = planes(&edges, &triangles).into_iter();
        cliques.extend(planes.map(|part| clique(&edges, &part, false)));
    }
    cliques.retain(|clique| !clique.rods.is_empty());
    cliques
}

/// The rigid rods among constraints, which come with their places, each pair of particles once, and the distances of
/// fixed particles that rods to one free particle bring together.
fn edges<'a, const D: usize>(
    constraints: impl Iterator<Item = (usize, &'a NamedConstraint)>,
    inverse_mass: &[f64],
    q: &[f64],
) -> Vec<Edge> {
    let mut known: Vec<Edge> = Vec::new();
    let mut held_by: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (place, named) in constraints {
        let Some(rod) = named.constraint.as_rod().filter(|rod| rod.compliance == 0.0 && rod.length > 0.0) else {
            continue;
        };
        let ends = [rod.a.0.min(rod.b.0), rod.a.0.max(rod.b.0)];
        known.push(Edge { ends, length: rod.length, rod: Some(ConstraintId(place)) });
        for (free, fixed) in [(rod.a.0, rod.b.0), (rod.b.0, rod.a.0)] {
            if inverse_mass[free] > 0.0 && inverse_mass[fixed] == 0.0 {
                held_by.entry(free).or_default().push(fixed);
            }
        }
    }
    // Two fixed particles span a line and three a plane: the distances from the first D − 1 are enough to find both.
    for fixed in held_by.values() {
        for (k, &one) in fixed.iter().enumerate().take(D - 1) {
            for &other in fixed[k + 1..].iter().filter(|&&other| other != one) {
                let ends = [one.min(other), one.max(other)];
                let length = norm(minus(block::<D>(q, ParticleId(one)), block::<D>(q, ParticleId(other))));
                known.push(Edge { ends, length, rod: None });
            }
        }
    }
    // The sort is stable: of several rods between two particles the first one counts.
    known.sort_by_key(|edge| edge.ends);
    known.dedup_by_key(|edge| edge.ends);
    known
}

/// Whether one of three lengths is the sum of the others.
fn is_tight(lengths: [f64; 3]) -> bool {
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let sum: f64 = lengths.into_iter().sum();
    (sum - 2.0 * longest).abs() <= TIGHT * longest
}

fn clique(edges: &[Edge], part: &[usize], is_line: bool) -> FlatClique {
    let mut particles: Vec<ParticleId> = part.iter().flat_map(|&edge| edges[edge].ends.map(ParticleId)).collect();
    particles.sort_unstable();
    particles.dedup();
    let mut rods: Vec<ConstraintId> = part.iter().filter_map(|&edge| edges[edge].rod).collect();
    rods.sort_unstable();
    FlatClique { particles, rods, is_line }
}

/// The edges of the planes that the triangles form, plane after plane: triangles belong to one plane where they are two
/// of a flat tetrahedron.
fn planes(edges: &[Edge], triangles: &[[u32; 3]]) -> Vec<Vec<usize>> {
    let number: BTreeMap<[u32; 3], usize> =
        triangles.iter().enumerate().map(|(k, sides)| (sorted(*sides), k)).collect();
    let mut at_edge: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (k, sides) in triangles.iter().enumerate() {
        sides.iter().for_each(|&side| at_edge.entry(side).or_default().push(k));
    }
    if at_edge.values().map(|around| around.len() * (around.len() - 1) / 2).sum::<usize>() > PAIRS {
        return Vec::new();
    }
    let edge_of: BTreeMap<[usize; 2], u32> = edges.iter().enumerate().map(|(k, edge)| (edge.ends, k as u32)).collect();
    let tip = |k: usize, base: u32| {
        let ends = triangles[k].iter().flat_map(|&side| edges[side as usize].ends);
        let base = edges[base as usize].ends;
        ends.into_iter().find(|end| !base.contains(end)).unwrap_or(base[0])
    };
    let mut same_plane = Classes::new(triangles.len());
    for (&base, around) in &at_edge {
        for (k, &one) in around.iter().enumerate() {
            for &other in &around[..k] {
                let tips = [tip(one, base), tip(other, base)];
                let Some(&far) = edge_of.get(&[tips[0].min(tips[1]), tips[0].max(tips[1])]) else { continue };
                if !is_flat(edges, triangles[one], triangles[other], base, far) {
                    continue;
                }
                // The other two triangles of the tetrahedron, unless their corners lie in a line.
                let side = |k: usize, end: usize| {
                    let ends = |side: &&u32| **side != base && edges[**side as usize].ends.contains(&end);
                    triangles[k].iter().find(ends).copied().unwrap_or(base)
                };
                let of_end = |end: usize| number.get(&sorted([side(one, end), side(other, end), far])).copied();
                let others = edges[base as usize].ends.map(of_end);
                let all: Vec<usize> = [Some(one), Some(other)].into_iter().chain(others).flatten().collect();
                same_plane.join(&all);
            }
        }
    }
    let of_plane = |plane: Vec<usize>| {
        let mut sides: Vec<usize> = plane.iter().flat_map(|&k| triangles[k].map(|side| side as usize)).collect();
        sides.sort_unstable();
        sides.dedup();
        sides
    };
    same_plane.parts().into_iter().map(of_plane).collect()
}

fn sorted(mut sides: [u32; 3]) -> [u32; 3] {
    sides.sort_unstable();
    sides
}

/// Whether two triangles on one base, whose tips are `far` apart, lie in one plane: in the plane of the base the tips
/// have the heights h and ±h′ above it.
fn is_flat(edges: &[Edge], one: [u32; 3], other: [u32; 3], base: u32, far: u32) -> bool {
    let length = |side: u32| edges[side as usize].length;
    let [a, _] = edges[base as usize].ends;
    // The tip of a triangle along the base and across it.
    let tip = |sides: [u32; 3]| {
        let (mut to_a, mut to_b) = (0.0, 0.0);
        for side in sides.into_iter().filter(|&side| side != base) {
            if edges[side as usize].ends.contains(&a) { to_a = length(side) } else { to_b = length(side) }
        }
        let along = (length(base) + (to_a - to_b) * (to_a + to_b) / length(base)) / 2.0;
        (along, ((to_a - along) * (to_a + along)).max(0.0).sqrt())
    };
    let ((x, h), (y, k)) = (tip(one), tip(other));
    let size = [base, far].into_iter().chain(one).chain(other).map(length).fold(0.0, f64::max);
    let squared = |heights: f64| (x - y) * (x - y) + heights * heights;
    // far² depends on the angle between the triangles as its cosine does: between these two, and flat only at them.
    let is_met = |heights: f64| (length(far) * length(far) - squared(heights)).abs() <= TIGHT * size * size;
    is_met(h - k) || is_met(h + k)
}

/// The graph with each edge directed to the end of higher degree.
struct Graph {
    /// For each particle the ends and the numbers of its outgoing edges, ascending.
    out: Vec<Vec<(usize, usize)>>,
}

impl Graph {
    fn new(particles: usize, edges: &[Edge]) -> Self {
        let mut degree = vec![0_usize; particles];
        edges.iter().flat_map(|edge| edge.ends).for_each(|end| degree[end] += 1);
        let mut out = vec![Vec::new(); particles];
        for (number, &Edge { ends: [a, b], .. }) in edges.iter().enumerate() {
            let (from, to) = if (degree[a], a) < (degree[b], b) { (a, b) } else { (b, a) };
            out[from].push((to, number));
        }
        out.iter_mut().for_each(|list: &mut Vec<(usize, usize)>| list.sort_unstable());
        Graph { out }
    }

    /// Calls `visit` with the three edges of each triangle.
    fn triangles(&self, edges: &[Edge], visit: &mut impl FnMut([usize; 3])) {
        for from in &self.out {
            for &(middle, first) in from {
                let (mut left, mut right) = (&from[..], &self.out[middle][..]);
                while let (Some(&(x, second)), Some(&(y, third))) = (left.first(), right.first()) {
                    if x == y {
                        debug_assert!(edges[second].ends.contains(&x) && edges[third].ends.contains(&x));
                        visit([first, second, third]);
                    }
                    left = if x <= y { &left[1..] } else { left };
                    right = if y <= x { &right[1..] } else { right };
                }
            }
        }
    }
}

/// Classes of numbers that were joined, by union and find.
pub(crate) struct Classes {
    parent: Vec<u32>,
}

impl Classes {
    pub(crate) fn new(count: usize) -> Self {
        Classes { parent: (0..count as u32).collect() }
    }

    fn root(&mut self, mut k: usize) -> usize {
        while self.parent[k] as usize != k {
            self.parent[k] = self.parent[self.parent[k] as usize];
            k = self.parent[k] as usize;
        }
        k
    }

    /// Joins the classes of all these numbers; whether any of them were not one class before.
    pub(crate) fn join(&mut self, numbers: &[usize]) -> bool {
        let mut is_new = false;
        for pair in numbers.windows(2) {
            let (a, b) = (self.root(pair[0]), self.root(pair[1]));
            self.parent[a.max(b)] = a.min(b) as u32;
            is_new |= a != b;
        }
        is_new
    }

    /// The classes of two numbers and more, each ascending.
    fn parts(mut self) -> Vec<Vec<usize>> {
        let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for k in 0..self.parent.len() {
            let root = self.root(k);
            parts.entry(root).or_default().push(k);
        }
        parts.into_values().filter(|part| part.len() > 1).collect()
    }
}
