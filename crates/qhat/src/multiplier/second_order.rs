//! Rods that hold only to second order.
//!
//! Three joints in a line, held by three rods whose lengths add up, form a lever: at first order the rods allow a
//! motion of the joint between across the line, and only the second-order terms of the lengths forbid it. The rows of
//! the rods depend on each other there, so a force across the line has no finite tensions; what is computed is noise,
//! divided by the height that roundoff leaves the triangle. The constraint force and the motion are right.
//!
//! `structure/cliques.rs` finds such rods by their lengths. Whether other rows hold the joints, as a truss does
//! around a chord in three pieces, is decided here by a generic velocity r that is made consistent with every row:
//!
//! ```text
//! v = r − W Jᵀ (J W Jᵀ)⁻¹ J r
//! ```
//!
//! J has the rods of a line as a tree and the rods of a plane as a truss in the plane, so that it does not depend on
//! the height that is left. Where v moves the joints of a clique as a rigid body does, to roundoff, their rods only
//! repeat each other. Otherwise second order holds them, and the system is given the rows of `structure/hold.rs`, which
//! hold them to first order (`System::set_second_order`). The rank is then that of the mechanism at positions near by.
//!
//! Source: Connelly and Whiteley, Second-order rigidity and prestress stability for tensegrity frameworks, SIAM J.
//! Discrete Math. 9 (1996).

use super::Equation;
use crate::cluster::rigid_rods;
use crate::constraint::{Constraint, Distance};
use crate::modes::Modes;
use crate::point::{Motion, block, minus, norm};
use crate::space::{Dimension, ParticleId, in_dimension};
use crate::state::State;
use crate::structure::{Classes, Flat, FlatClique, relations};
use crate::system::System;

/// |Σ w v| relative to the fastest particle above which v bends a clique. A solve for forces is right to ten digits and
/// more, and a generic v bends what can bend by some hundredths in the largest lever of the tests.
const BENDS: f64 = 1e-6;

/// The degrees of freedom where rods hold only to second order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Freedom {
    /// Velocities that no row forbids at this position.
    pub here: usize,
    /// Degrees of freedom of the mechanism at positions near by.
    pub nearby: usize,
}

/// Of the flat cliques of a system, those whose joints rods hold only to second order, at a state that satisfies the
/// constraints.
pub(crate) fn second_order(system: &System, state: &State, cliques: Vec<FlatClique>) -> Vec<FlatClique> {
    in_dimension!(system.dimension, D => bent::<D>(system, state, cliques))
}

/// The degrees of freedom at a state; `None` if no rods hold to second order only.
pub(crate) fn freedom(system: &System, state: &State) -> Option<Freedom> {
    let cliques = &system.second_order;
    if cliques.is_empty() {
        return None;
    }
    let coordinates = system.dimension() * system.inverse_mass.iter().filter(|&&w| w > 0.0).count();
    in_dimension!(system.dimension, D => {
        let first_order = system.with_cliques(cliques, &|clique| at_first_order::<D>(system, clique, &state.q));
        let rank = |system: &System| factored::<D>(system, state).solver.rank(&system.matrix);
        let left = |system: &System| coordinates.saturating_sub(rank(system));
        Some(Freedom { here: left(&first_order), nearby: left(system) })
    })
}

/// The cliques that a generic consistent velocity bends.
fn bent<const D: usize>(system: &System, state: &State, cliques: Vec<FlatClique>) -> Vec<FlatClique> {
    let first_order = system.with_cliques(&cliques, &|clique| at_first_order::<D>(system, clique, &state.q));
    let mut equation = factored::<D>(&first_order, state);
    let moves = |k: usize| if system.inverse_mass[k / D] > 0.0 { 1.0 } else { 0.0 };
    // Any numbers without a pattern do.
    let mut v: Vec<f64> =
        (0..state.q.len()).map(|k| moves(k) * ((k as f64 * 0.618_033_988_749_895).fract() - 0.5)).collect();
    let m = first_order.all_row_count();
    let (mut rate, mut nu) = (vec![0.0; m], vec![0.0; m]);
    equation.rows.J.multiply::<D>(&v, &mut rate);
    equation.solver.solve(&first_order.matrix, &rate, &mut nu);
    equation.rows.J.add_impulse::<D>(&system.inverse_mass, &nu, -1.0, &mut v);
    let bends = |clique: &FlatClique| {
        let fastest = clique.particles.iter().map(|&id| norm(block::<D>(&v, id))).fold(0.0, f64::max);
        relations::<D>(clique, &system.inverse_mass, &state.q).iter().any(|relation| {
            let mut sum = [0.0; D];
            for &(id, weight) in &relation.terms {
                let v = block::<D>(&v, id);
                sum = std::array::from_fn(|k| sum[k] + weight * v[k]);
            }
            norm(sum) > BENDS * fastest
        })
    };
    cliques.into_iter().filter(bends).collect()
}

/// The equation of a system with A factored at a state, its contacts open.
fn factored<const D: usize>(system: &System, state: &State) -> Equation {
    let mut equation = Equation::new(system);
    equation.set_modes(system, &Modes::at_first(&system.contacts));
    equation.constrain(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t });
    equation.factor::<D>(system, 0.0);
    equation
}

/// Rods that span the rows of a clique at first order: a tree along a line, in which fixed particles count as one; a
/// truss in the plane of the others.
fn at_first_order<const D: usize>(system: &System, clique: &FlatClique, q: &[f64]) -> Vec<Constraint> {
    let rods = clique.rods.iter().filter_map(|&id| system.constraints[id.0].constraint.as_rod());
    if clique.is_line {
        let first_fixed = clique.particles.iter().position(|&id| system.is_fixed(id));
        let place = |id: ParticleId| {
            let own = clique.particles.binary_search(&id).unwrap_or(0);
            if system.is_fixed(id) { first_fixed.unwrap_or(own) } else { own }
        };
        let mut tree = Classes::new(clique.particles.len());
        return rods.filter(|rod| tree.join(&[place(rod.a), place(rod.b)])).map(|rod| rod.clone().into()).collect();
    }
    let points = Flat::of::<D>(clique, q).in_plane();
    match rigid_rods(Dimension::Two, &points) {
        Ok(pairs) => pairs
            .into_iter()
            .map(|[a, b]| {
                let length = norm(minus(points[b], points[a]));
                Distance::new(clique.particles[a], clique.particles[b], length).into()
            })
            .collect(),
        // Two joints at one place: the rods as they are.
        Err(_) => rods.map(|rod| rod.clone().into()).collect(),
    }
}
