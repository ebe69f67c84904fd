//! Open chains in eight lanes: the equation, the projection and the drift of a system that has nothing else.
//!
//! Same mathematics as `multiplier`, other order of work: the rows are taken in the half squared form, assembled, factored and
//! solved in two sweeps along the chains (`path.rs`), with particles stored in blocks of eight (`plan.rs`). A test holds its
//! accelerations to those of the general path. Where a pivot is tiny the caller goes over to the general path.

mod forces;
mod path;
mod plan;
#[cfg(test)]
mod tests;
mod vector;

pub(crate) use plan::Plan;
pub(crate) use vector::{F8, LANES, Largest, V, vector_unit};

use crate::measure::Drift;
use crate::state::State;
use crate::system::System;
use forces::Forces;
use path::{Eliminated, RightSide, solve};
use plan::Stretch;
use pulp::{Simd, WithSimd};
use std::ops::Range;
use vector::{dot, load, minus};

/// Newton's method with a factor of its own each time: from the error of one substep it takes one or two iterations.
const MAX_ITERATIONS: usize = 8;

/// Outcome of a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Projected {
    /// Converged in so many iterations.
    Met(usize),
    /// It did not converge.
    NotMet,
    /// A pivot is tiny: rows depend on each other, and the general path must see to it.
    Singular,
}

/// Arrays of one system in lanes.
#[derive(Clone, Debug)]
pub(crate) struct Lanes {
    forces: Forces,
    rows: Vec<Eliminated>,
    delta: Vec<F8>,
}

impl Lanes {
    pub(crate) fn new(system: &System, plan: &Plan) -> Self {
        Lanes {
            forces: Forces::new(system, plan),
            rows: vec![Eliminated::default(); plan.blocks()],
            delta: vec![F8::ZERO; plan.blocks() * system.dimension()],
        }
    }

    /// Lays the state into lanes, nailed particles at their nails, and asks the constant forces.
    pub(crate) fn begin<const D: usize>(
        &mut self,
        system: &System,
        plan: &Plan,
        state: &State,
        q: &mut [F8],
        qd: &mut [F8],
    ) {
        let (user_q, user_qd) = (&mut self.forces.q, &mut self.forces.qd);
        user_q.copy_from_slice(&state.q);
        user_qd.copy_from_slice(&state.qd);
        hold_nailed::<D>(plan, user_q, user_qd);
        for place in plan.homes.iter().chain(&plan.copies) {
            for c in 0..D {
                q[place.block * D + c].0[place.lane] = user_q[place.particle * D + c];
                qd[place.block * D + c].0[place.lane] = user_qd[place.particle * D + c];
            }
        }
        self.forces.begin::<D>(system, plan);
    }

    /// Writes a motion in lanes back to the user's order.
    pub(crate) fn end<const D: usize>(&self, plan: &Plan, q: &[F8], qd: &[F8], state: &mut State) {
        for place in &plan.homes {
            for c in 0..D {
                state.q[place.particle * D + c] = q[place.block * D + c].0[place.lane];
                state.qd[place.particle * D + c] = qd[place.block * D + c].0[place.lane];
            }
        }
        hold_nailed::<D>(plan, &mut state.q, &mut state.qd);
    }

    /// Writes q̈ at a motion, and returns the power of the forces without a potential [W]; `None` where rows depend on each
    /// other.
    pub(crate) fn accelerate<const D: usize>(
        &mut self,
        system: &System,
        plan: &Plan,
        q: &[F8],
        qd: &[F8],
        qdd: &mut [F8],
    ) -> Option<f64> {
        let (WQ, power) = self.forces.apply::<D>(system, plan, q, qd);
        let rows = &mut self.rows;
        let right = |_, at: Range<usize>| Acceleration { qd: &qd[at.clone()], WQ: &WQ[at] };
        let solve = Solve::<_, D> { plan, q, right, rows, out: qdd };
        vector_unit().dispatch(solve).then_some(power)
    }

    /// Brings q onto C = 0, then q̇ onto Ċ = 0. `attainable` is the |C| relative to r at which to stop.
    pub(crate) fn project<const D: usize>(
        &mut self,
        plan: &Plan,
        q: &mut [F8],
        qd: &mut [F8],
        attainable: f64,
    ) -> Projected {
        let (rows, out) = (&mut self.rows[..], &mut self.delta[..]);
        for iteration in 0..=MAX_ITERATIONS {
            let off = vector_unit().dispatch(Measure::<D> { plan, q, qd }).relative_length;
            if off <= attainable {
                let change = &*qd;
                let right = |_, at: Range<usize>| Velocity { qd: &change[at] };
                let is_regular = vector_unit().dispatch(Solve::<_, D> { plan, q, right, rows, out });
                qd.copy_from_slice(out);
                return if is_regular { Projected::Met(iteration) } else { Projected::Singular };
            }
            if !off.is_finite() {
                break;
            }
            let from = &*q;
            let right = |stretch, at: Range<usize>| Position { stretch, q: &from[at] };
            if !vector_unit().dispatch(Solve::<_, D> { plan, q: from, right, rows, out }) {
                return Projected::Singular;
            }
            q.copy_from_slice(out);
        }
        Projected::NotMet
    }

    /// What is left of C = 0 and Ċ = 0.
    pub(crate) fn drift<const D: usize>(&self, plan: &Plan, q: &[F8], qd: &[F8]) -> Drift {
        vector_unit().dispatch(Measure::<D> { plan, q, qd })
    }
}

fn hold_nailed<const D: usize>(plan: &Plan, q: &mut [f64], qd: &mut [f64]) {
    for (particle, at) in &plan.nailed {
        q[particle * D..][..D].copy_from_slice(&at[..D]);
        qd[particle * D..][..D].fill(0.0);
    }
}

/// `solve` for every group. `right` makes the right side of a group from its stretch and its places in arrays.
struct Solve<'a, B, const D: usize> {
    plan: &'a Plan,
    q: &'a [F8],
    right: B,
    rows: &'a mut [Eliminated],
    out: &'a mut [F8],
}

impl<'a, R: RightSide<D>, B: Fn(Stretch<'a>, Range<usize>) -> R, const D: usize> WithSimd for Solve<'a, B, D> {
    /// Whether all of them are regular.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let mut is_regular = true;
        for stretch in self.plan.stretches() {
            let (blocks, at) = (stretch.group.blocks(), stretch.group.coordinates::<D>());
            let right = (self.right)(stretch, at.clone());
            is_regular &= solve(simd, stretch, &self.q[at.clone()], &right, &mut self.rows[blocks], &mut self.out[at]);
        }
        is_regular
    }
}

/// q̈: b = −γ − J W Q, on top of W Q.
struct Acceleration<'a> {
    qd: &'a [F8],
    WQ: &'a [F8],
}

impl<const D: usize> RightSide<D> for Acceleration<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [V<S>; D]) -> V<S> {
        let u = minus(load::<S, D>(simd, self.qd, i), load(simd, self.qd, i - 1));
        let pull = minus(load::<S, D>(simd, self.WQ, i), load(simd, self.WQ, i - 1));
        -(dot(u, u) + dot(d, pull))
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [V<S>; D] {
        load(simd, self.WQ, i)
    }
}

/// q̇ on Ċ = 0: b = −Ċ, on top of q̇.
struct Velocity<'a> {
    qd: &'a [F8],
}

impl<const D: usize> RightSide<D> for Velocity<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [V<S>; D]) -> V<S> {
        -dot(d, minus(load(simd, self.qd, i), load(simd, self.qd, i - 1)))
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [V<S>; D] {
        load(simd, self.qd, i)
    }
}

/// One iteration of q towards C = 0: b = −C, on top of q.
struct Position<'a> {
    stretch: Stretch<'a>,
    q: &'a [F8],
}

impl<const D: usize> RightSide<D> for Position<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [V<S>; D]) -> V<S> {
        -residual(simd, self.stretch, i, d)
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [V<S>; D] {
        load(simd, self.q, i)
    }
}

/// C = ½(d·d − r²).
#[inline(always)]
fn residual<S: Simd, const D: usize>(simd: S, stretch: Stretch<'_>, i: usize, d: [V<S>; D]) -> V<S> {
    let r = V::load(simd, &stretch.r[i]);
    0.5 * (dot(d, d) - r * r)
}

/// What is left of C = 0 and Ċ = 0. Near C = 0, |d| − r = C/r and its rate is d·u/r.
struct Measure<'a, const D: usize> {
    plan: &'a Plan,
    q: &'a [F8],
    qd: &'a [F8],
}

impl<const D: usize> WithSimd for Measure<'_, D> {
    type Output = Drift;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Drift {
        let zero = V::splat(simd, 0.0);
        let (mut length, mut rate, mut relative) = (zero, zero, zero);
        for stretch in self.plan.stretches() {
            let at = stretch.group.coordinates::<D>();
            let (q, qd) = (&self.q[at.clone()], &self.qd[at]);
            for i in 1..=stretch.group.rows {
                let inverse_r = V::load(simd, &stretch.inverse_r[i]);
                let d = minus(load::<S, D>(simd, q, i), load(simd, q, i - 1));
                let u = minus(load::<S, D>(simd, qd, i), load(simd, qd, i - 1));
                let off = (inverse_r * residual(simd, stretch, i, d)).abs();
                length = length.larger(off);
                relative = relative.larger(inverse_r * off);
                rate = rate.larger((inverse_r * dot(d, u)).abs());
            }
        }
        let relative_length = relative.stored().largest();
        Drift {
            residual: length.stored().largest(),
            residual_rate: rate.stored().largest(),
            relative: relative_length,
            relative_length,
            worst_row: 0,
        }
    }
}
