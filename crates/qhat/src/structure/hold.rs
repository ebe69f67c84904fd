//! The rows that hold flat cliques, in place of rods that hold them only to second order.
//!
//! ```text
//! x_i = Σ w_ik x_k,  Σ w_ik = 1         corners k, two of a line and three of a plane: d rows a joint, constant J
//! |x_a − x_b|² = vᵀ G v                 v: the offset of a and b at the start, in the line or plane
//! ```
//!
//! The first rows keep the clique an affine image of what it is at the start. One number G in a line, three in a plane
//! then say every distance: as many rods are kept as there are numbers that nothing else fixes, and the lengths of the
//! other rods follow at every position. Fixed particles fix the distances between them, and so do two particles of
//! another clique. These rows are independent wherever the particles go, unless cliques close a loop.

use super::FlatClique;
use crate::constraint::{NamedConstraint, Relation};
use crate::number::raised;
use crate::point::{block, dot, minus, norm, scaled};
use crate::space::{ConstraintId, ParticleId};
use std::collections::BTreeMap;

/// Distance, relative to the size of a clique, below which a fixed particle is no corner of its own. Positions are good
/// to 1e-10 and more, and the weights of other particles to that over this distance.
const APART: f64 = 1e-3;

/// Part of the length of a rod squared that must not follow from G as it is known, for the rod to say more.
const SAYS_MORE: f64 = 1e-6;

/// Weight of a corner that can move below which a fixed particle follows from fixed corners.
const NO_PART: f64 = 1e-6;

/// The rows that hold flat cliques, and the rods whose lengths then follow.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hold {
    /// Joints as linear combinations of corners; the joint comes first.
    pub(crate) relations: Vec<Relation>,
    /// The rods of the cliques whose lengths follow, ascending.
    pub(crate) following: Vec<ConstraintId>,
}

/// Finds these rows and rods for cliques at q \[m\]; cliques in a plane come last in the list.
pub(crate) fn hold<const D: usize>(
    constraints: &[NamedConstraint],
    inverse_mass: &[f64],
    cliques: &[FlatClique],
    q: &[f64],
) -> Hold {
    let mut hold = Hold::default();
    let mut kept: Vec<ConstraintId> = Vec::new();
    let mut bodies = Bodies::new(inverse_mass);
    let mut planes: BTreeMap<ParticleId, Vec<&FlatClique>> = BTreeMap::new();
    for plane in cliques.iter().filter(|clique| !clique.is_line) {
        plane.particles.iter().for_each(|&id| planes.entry(id).or_default().push(plane));
    }
    // A line within a plane is held by the plane.
    for clique in cliques.iter().rev() {
        let has_all = |plane: &&FlatClique| clique.particles.iter().all(|id| plane.particles.binary_search(id).is_ok());
        let around = clique.particles.first().and_then(|id| planes.get(id));
        if !clique.is_line || !around.is_some_and(|planes| planes.iter().any(has_all)) {
            hold.relations.extend(relations::<D>(clique, inverse_mass, q));
        }
        let flat = Flat::of::<D>(clique, q);
        let offset = |[a, b]: [usize; 2]| {
            let [a, b] = [a, b].map(|k| flat.coordinates[k]);
            [b[0] - a[0], b[1] - a[1]]
        };
        let mut metric = Metric { known: Vec::new(), unknown: if clique.is_line { 1 } else { 3 } };
        bodies.known_pairs(clique).into_iter().for_each(|pair| metric.learn(offset(pair)));
        let place = |id: ParticleId| clique.particles.binary_search(&id).ok();
        let rods = clique.rods.iter().filter_map(|&id| {
            let rod = constraints[id.0].constraint.as_rod()?;
            Some((id, offset([place(rod.a)?, place(rod.b)?])))
        });
        let rods: Vec<(ConstraintId, [f64; 2])> = rods.collect();
        while let Some((id, offset)) = metric.best(&rods) {
            metric.learn(offset);
            kept.push(id);
        }
    }
    hold.following = cliques.iter().flat_map(|clique| clique.rods.iter().copied()).collect();
    hold.following.sort_unstable();
    hold.following.dedup();
    kept.sort_unstable();
    hold.following.retain(|rod| kept.binary_search(rod).is_err());
    hold
}

/// Every particle of a clique that is no corner, as a linear combination of the corners; not where all these are fixed.
pub(crate) fn relations<const D: usize>(clique: &FlatClique, inverse_mass: &[f64], q: &[f64]) -> Vec<Relation> {
    let flat = Flat::of::<D>(clique, q);
    let is_fixed = |k: usize| inverse_mass[clique.particles[k].0] == 0.0;
    let corners = flat.corners(clique.is_line, &is_fixed);
    let relation = |k: usize| {
        let shares: Vec<(usize, f64)> = corners.iter().copied().zip(flat.weights(&corners, k)).collect();
        let moves = !is_fixed(k) || shares.iter().any(|&(corner, weight)| !is_fixed(corner) && weight.abs() > NO_PART);
        let shares = shares.into_iter().filter(|&(_, weight)| weight != 0.0);
        let shares = shares.map(|(corner, weight)| (clique.particles[corner], -weight));
        let terms: Vec<_> = std::iter::once((clique.particles[k], 1.0)).chain(shares).collect();
        moves.then(|| Relation::homogeneous(terms))
    };
    (0..clique.particles.len()).filter(|k| !corners.contains(k)).filter_map(relation).collect()
}

/// The groups of particles whose distances are known: the fixed ones, and those of cliques that are held.
struct Bodies {
    /// For each particle the numbers of its groups.
    groups: Vec<Vec<u32>>,
    count: u32,
}

impl Bodies {
    fn new(inverse_mass: &[f64]) -> Self {
        let groups = inverse_mass.iter().map(|&w| if w == 0.0 { vec![0] } else { Vec::new() });
        Bodies { groups: groups.collect(), count: 1 }
    }

    /// Pairs of particles of a clique, by their places, whose distances the groups so far say; the clique is then one
    /// of the groups.
    fn known_pairs(&mut self, clique: &FlatClique) -> Vec<[usize; 2]> {
        let mut common: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (k, id) in clique.particles.iter().enumerate() {
            for &group in &self.groups[id.0] {
                common.entry(group).or_default().push(k);
            }
            self.groups[id.0].push(self.count);
        }
        self.count += 1;
        let mut pairs = Vec::new();
        for together in common.values() {
            // The distances from two particles say all.
            for (k, &a) in together.iter().enumerate().take(2) {
                pairs.extend(together[k + 1..].iter().map(|&b| [a, b]));
            }
        }
        pairs
    }
}

/// G as far as it is known: an orthonormal basis of the products v vᵀ along which it is.
struct Metric {
    known: Vec<[f64; 3]>,
    /// The numbers of G that are not known.
    unknown: usize,
}

impl Metric {
    /// The part of v vᵀ that does not follow from what is known; the square of a length, or 0.
    fn news(&self, v: [f64; 2]) -> [f64; 3] {
        let product = [v[0] * v[0], v[1] * v[1], std::f64::consts::SQRT_2 * v[0] * v[1]];
        let mut rest = product;
        // Once more takes out what roundoff has left.
        for basis in self.known.iter().chain(&self.known) {
            rest = minus(rest, scaled(dot(rest, *basis), *basis));
        }
        if norm(rest) > SAYS_MORE * norm(product) { rest } else { [0.0; 3] }
    }

    /// Takes the distance of two particles with an offset as known.
    fn learn(&mut self, offset: [f64; 2]) {
        let news = self.news(offset);
        if self.unknown > 0 && norm(news) > 0.0 {
            self.known.push(scaled(1.0 / norm(news), news));
            self.unknown -= 1;
        }
    }

    /// The rod that says most; `None` if all is known.
    fn best(&self, rods: &[(ConstraintId, [f64; 2])]) -> Option<(ConstraintId, [f64; 2])> {
        if self.unknown == 0 {
            return None;
        }
        let says = rods.iter().map(|&(id, offset)| (norm(self.news(offset)), id, offset));
        let best = says.reduce(|best, next| if next.0 > best.0 { next } else { best });
        best.filter(|&(says, ..)| says > 0.0).map(|(_, id, offset)| (id, offset))
    }
}

/// Points in a line or a plane, as their coordinates along two unit vectors from the first point. Across a line the
/// coordinate is 0: what roundoff leaves there is left out.
pub(crate) struct Flat {
    coordinates: Vec<[f64; 2]>,
}

impl Flat {
    /// The particles of a clique at q.
    pub(crate) fn of<const D: usize>(clique: &FlatClique, q: &[f64]) -> Self {
        let points: Vec<[f64; 3]> = clique.particles.iter().map(|&id| raised(block::<D>(q, id))).collect();
        let origin = points[0];
        let far = |from: &dyn Fn([f64; 3]) -> f64| {
            points.iter().copied().fold(origin, |best, x| if from(x) > from(best) { x } else { best })
        };
        let unit = |d: [f64; 3]| if norm(d) > 0.0 { scaled(1.0 / norm(d), d) } else { d };
        let along = unit(minus(far(&|x| norm(minus(x, origin))), origin));
        let across = |x: [f64; 3]| {
            let d = minus(x, origin);
            minus(d, scaled(dot(d, along), along))
        };
        let beside = if clique.is_line { [0.0; 3] } else { unit(across(far(&|x| norm(across(x))))) };
        let coordinates = points.iter().map(|&x| [dot(minus(x, origin), along), dot(across(x), beside)]).collect();
        Flat { coordinates }
    }

    /// The coordinates as points of the plane.
    pub(crate) fn in_plane(&self) -> Vec<[f64; 3]> {
        self.coordinates.iter().map(|&[x, y]| [x, y, 0.0]).collect()
    }

    /// Two points of a line, three of a plane: fixed ones, as far as they span it, and then the farthest.
    fn corners(&self, is_line: bool, is_fixed: &dyn Fn(usize) -> bool) -> Vec<usize> {
        let count = self.coordinates.len();
        let farthest = |fixed_only: bool, from: &dyn Fn(usize) -> f64| {
            let among = (0..count).filter(|&k| !fixed_only || is_fixed(k)).map(|k| (from(k), k));
            among.reduce(|best, next| if next.0 > best.0 { next } else { best }).unwrap_or((0.0, 0))
        };
        let corner = |from: &dyn Fn(usize) -> f64| {
            let (of_all, of_fixed) = (farthest(false, from), farthest(true, from));
            if of_fixed.0 > APART * of_all.0 { of_fixed.1 } else { of_all.1 }
        };
        let first = (0..count).find(|&k| is_fixed(k));
        let first = first.unwrap_or_else(|| corner(&|k| norm(self.offset(0, k))));
        let second = corner(&|k| norm(self.offset(first, k)));
        if is_line {
            return vec![first, second];
        }
        let third = corner(&|k| area(self.offset(first, second), self.offset(first, k)).abs());
        vec![first, second, third]
    }

    /// The weights of corners that give a point; their sum is 1.
    fn weights(&self, corners: &[usize], k: usize) -> Vec<f64> {
        let (to, b) = (self.offset(corners[0], k), self.offset(corners[0], corners[1]));
        let others = match corners.get(2) {
            Some(&corner) => {
                let c = self.offset(corners[0], corner);
                vec![area(to, c) / area(b, c), area(b, to) / area(b, c)]
            }
            None => vec![dot(to, b) / dot(b, b)],
        };
        std::iter::once(1.0 - others.iter().sum::<f64>()).chain(others).collect()
    }

    fn offset(&self, a: usize, b: usize) -> [f64; 2] {
        minus(self.coordinates[b], self.coordinates[a])
    }
}

/// Twice the area of the triangle on two sides.
fn area(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
