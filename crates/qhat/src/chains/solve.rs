//! λ of every chain for three right-hand sides: accelerations, velocities and positions.
//!
//! Groups are independent of each other, so a large number of groups is distributed over several threads. Each group
//! computes the same numbers for any number of threads.

use super::path::{Eliminated, RightSide, solve};
use crate::linalg::eight::{F8, Wide, dot, load, minus, vector_unit};
use crate::structure::chains::{ChainPlan, Group, Stretch};
use crate::threads;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Work for one thread [blocks]: about 20 µs, a hundred times the cost of handing it to a thread.
const SHARE: usize = 512;

/// Runs `solve` for consecutive groups. `right` makes the right-hand side of a group from its stretch and its ranges.
pub(super) struct Solve<'a, B, const D: usize> {
    pub(super) plan: &'a ChainPlan,
    pub(super) groups: &'a [Group],
    pub(super) q: &'a [F8],
    pub(super) right: &'a B,
    /// Scratch with space for the rows of the largest group.
    pub(super) rows: &'a mut [Eliminated],
    /// Solves these groups one after the other.
    pub(super) out: &'a mut [F8],
    /// Part of its diagonal below which a pivot is tiny.
    pub(super) tiny: f64,
}

impl<'a, R: RightSide<D>, B: Fn(Stretch<'a>, Range<usize>) -> R + Sync, const D: usize> Solve<'a, B, D> {
    /// Whether all of them are regular.
    pub(super) fn run(self) -> bool {
        if self.groups.len() < 2 || self.rows.len() < 2 * SHARE {
            return vector_unit().dispatch(self);
        }
        let Solve { plan, groups, q, right, rows, out, tiny } = self;
        let (left, rest) = groups.split_at(groups.len() / 2);
        let blocks = rest[0].first - left[0].first;
        let (left_rows, rest_rows) = rows.split_at_mut(blocks);
        let (left_out, rest_out) = out.split_at_mut(blocks * D);
        let (one, other) = threads::both(
            || Solve { plan, groups: left, q, right, rows: left_rows, out: left_out, tiny }.run(),
            || Solve { plan, groups: rest, q, right, rows: rest_rows, out: rest_out, tiny }.run(),
        );
        one && other
    }
}

impl<'a, R: RightSide<D>, B: Fn(Stretch<'a>, Range<usize>) -> R, const D: usize> WithSimd for Solve<'a, B, D> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let mut is_regular = true;
        let mut out = self.out;
        for stretch in self.plan.stretches(self.groups) {
            let (blocks, at) = (stretch.group.rows + 1, stretch.group.coordinates::<D>());
            let right = (self.right)(stretch, at.clone());
            // Every group overwrites the same rows, which therefore stay in the cache.
            is_regular &= solve(simd, stretch, &self.q[at], &right, self.rows, out, self.tiny);
            out = &mut out[blocks * D..];
        }
        is_regular
    }
}

/// The right-hand side for q̈: b = −γ − J W Q, added to W Q.
pub(super) struct Acceleration<'a> {
    pub(super) qd: &'a [F8],
    pub(super) WQ: &'a [F8],
}

impl<const D: usize> RightSide<D> for Acceleration<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [Wide<S>; D]) -> Wide<S> {
        let u = minus(load::<S, D>(simd, self.qd, i), load(simd, self.qd, i - 1));
        let pull = minus(load::<S, D>(simd, self.WQ, i), load(simd, self.WQ, i - 1));
        -(dot(u, u) + dot(d, pull))
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [Wide<S>; D] {
        load(simd, self.WQ, i)
    }
}

/// The right-hand side for q̇ on Ċ = 0: b = −Ċ, added to q̇.
pub(super) struct Velocity<'a> {
    pub(super) qd: &'a [F8],
}

impl<const D: usize> RightSide<D> for Velocity<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [Wide<S>; D]) -> Wide<S> {
        -dot(d, minus(load(simd, self.qd, i), load(simd, self.qd, i - 1)))
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [Wide<S>; D] {
        load(simd, self.qd, i)
    }
}

/// The right-hand side for one iteration of q towards C = 0: b = −C, added to q.
pub(super) struct Position<'a> {
    pub(super) stretch: Stretch<'a>,
    pub(super) q: &'a [F8],
}

impl<const D: usize> RightSide<D> for Position<'_> {
    #[inline(always)]
    fn row<S: Simd>(&self, simd: S, i: usize, d: [Wide<S>; D]) -> Wide<S> {
        -residual(simd, self.stretch, i, d)
    }

    #[inline(always)]
    fn free<S: Simd>(&self, simd: S, i: usize) -> [Wide<S>; D] {
        load(simd, self.q, i)
    }
}

/// C = ½(d·d − r²).
#[inline(always)]
pub(super) fn residual<S: Simd, const D: usize>(simd: S, stretch: Stretch<'_>, i: usize, d: [Wide<S>; D]) -> Wide<S> {
    let r = Wide::load(simd, &stretch.r[i]);
    0.5 * (dot(d, d) - r * r)
}
