//! Chains: the equation, the projection and the drift of a system that consists of open chains, in eight lanes.
//!
//! The mathematics is the same as in `multiplier`. The order of work differs: rows are taken in the half squared form,
//! and are assembled, factored and solved in two sweeps along the chains (`path.rs`), with particles stored in blocks
//! of eight (`structure/chains.rs`). A test compares its accelerations with those of the general path. If a pivot is
//! tiny, the caller continues on the general path.

mod drift;
mod forces;
mod path;
mod solve;
#[cfg(test)]
mod tests;

use crate::drift::Drift;
use crate::linalg::eight::{F8, vector_unit};
use crate::state::State;
use crate::structure::ChainPlan;
use crate::system::System;
use drift::Measure;
use forces::Forces;
use path::Eliminated;
use solve::{Acceleration, Position, Solve, Velocity};
use std::ops::Range;

/// Most iterations of a projection. Newton's method with a new factor in each iteration needs one or two after a
/// substep.
const MAX_ITERATIONS: usize = 8;

/// Part of its diagonal below which a pivot counts as zero, where no position near by is known at which rows depend on
/// each other. Pivots of a chain with a free end are as small as the smallest ratio of inverse masses.
pub(crate) const TINY_PIVOT: f64 = 1e-12;

/// Outcome of a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Projected {
    /// The projection converged in this number of iterations.
    Met(usize),
    /// The projection did not converge.
    NotMet,
    /// A pivot is tiny: rows depend on each other, and the caller continues on the general path.
    Singular,
}

/// Arrays of one system of open chains.
#[derive(Clone, Debug)]
pub(crate) struct Chains {
    forces: Forces,
    rows: Vec<Eliminated>,
    delta: Vec<F8>,
    /// Part of its diagonal below which a pivot counts as zero.
    pub(crate) tiny: f64,
}

impl Chains {
    pub(crate) fn new(system: &System, plan: &ChainPlan) -> Self {
        Chains {
            forces: Forces::new(system, plan),
            rows: vec![Eliminated::default(); plan.blocks()],
            delta: vec![F8::ZERO; plan.blocks() * system.dimension()],
            tiny: TINY_PIVOT,
        }
    }

    /// Copies the state into lanes, puts nailed particles at their nails, and evaluates the constant forces.
    pub(crate) fn begin<const D: usize>(
        &mut self,
        system: &System,
        plan: &ChainPlan,
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
        self.forces.begin::<D>(system, plan, state.t);
    }

    /// Copies a motion from lanes to the user's order.
    pub(crate) fn end<const D: usize>(&self, plan: &ChainPlan, q: &[F8], qd: &[F8], state: &mut State) {
        for place in &plan.homes {
            for c in 0..D {
                state.q[place.particle * D + c] = q[place.block * D + c].0[place.lane];
                state.qd[place.particle * D + c] = qd[place.block * D + c].0[place.lane];
            }
        }
        hold_nailed::<D>(plan, &mut state.q, &mut state.qd);
    }

    /// Writes q̈ at a motion and returns the power of the forces without a potential [W]. `None` if rows depend on each
    /// other.
    pub(crate) fn accelerate<const D: usize>(
        &mut self,
        system: &System,
        plan: &ChainPlan,
        q: &[F8],
        qd: &[F8],
        t: f64,
        qdd: &mut [F8],
    ) -> Option<f64> {
        let (WQ, power) = self.forces.apply::<D>(system, plan, q, qd, t);
        let tiny = self.tiny;
        let right = &|_, at: Range<usize>| Acceleration { qd: &qd[at.clone()], WQ: &WQ[at] };
        let is_regular =
            Solve::<_, D> { plan, groups: &plan.groups, q, right, rows: &mut self.rows, out: qdd, tiny }.run();
        is_regular.then_some(power)
    }

    /// Projects q onto C = 0, then q̇ onto Ċ = 0. The iteration stops at |C| ≤ `attainable` · r.
    pub(crate) fn project<const D: usize>(
        &mut self,
        plan: &ChainPlan,
        q: &mut [F8],
        qd: &mut [F8],
        attainable: f64,
    ) -> Projected {
        let tiny = self.tiny;
        let (groups, rows, out) = (&plan.groups[..], &mut self.rows[..], &mut self.delta[..]);
        for iteration in 0..=MAX_ITERATIONS {
            let off = vector_unit().dispatch(Measure::<D> { plan, q, qd }).relative_length;
            if off <= attainable {
                let change = &*qd;
                let right = &|_, at: Range<usize>| Velocity { qd: &change[at] };
                let is_regular = Solve::<_, D> { plan, groups, q, right, rows, out, tiny }.run();
                qd.copy_from_slice(out);
                return if is_regular { Projected::Met(iteration) } else { Projected::Singular };
            }
            if !off.is_finite() {
                break;
            }
            let from = &*q;
            let right = &|stretch, at: Range<usize>| Position { stretch, q: &from[at] };
            if !(Solve::<_, D> { plan, groups, q: from, right, rows, out, tiny }).run() {
                return Projected::Singular;
            }
            q.copy_from_slice(out);
        }
        Projected::NotMet
    }

    /// The residuals of C = 0 and Ċ = 0.
    pub(crate) fn drift<const D: usize>(&self, plan: &ChainPlan, q: &[F8], qd: &[F8]) -> Drift {
        vector_unit().dispatch(Measure::<D> { plan, q, qd })
    }
}

fn hold_nailed<const D: usize>(plan: &ChainPlan, q: &mut [f64], qd: &mut [f64]) {
    for (particle, at) in &plan.nailed {
        q[particle * D..][..D].copy_from_slice(&at[..D]);
        qd[particle * D..][..D].fill(0.0);
    }
}
