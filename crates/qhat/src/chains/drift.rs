//! Drift of chains: the length error of every rod and its rate.

use super::solve::residual;
use crate::drift::Drift;
use crate::linalg::eight::{F8, Wide, dot, load, minus};
use crate::structure::chains::ChainPlan;
use pulp::{Simd, WithSimd};

/// The residuals of C = 0 and Ċ = 0. Near C = 0, |d| − r = C/r and its rate is d·u/r.
pub(super) struct Measure<'a, const D: usize> {
    pub(super) plan: &'a ChainPlan,
    pub(super) q: &'a [F8],
    pub(super) qd: &'a [F8],
}

impl<const D: usize> WithSimd for Measure<'_, D> {
    type Output = Drift;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Drift {
        let zero = Wide::splat(simd, 0.0);
        let (mut length, mut rate, mut relative) = (zero, zero, zero);
        for stretch in self.plan.stretches(&self.plan.groups) {
            let at = stretch.group.coordinates::<D>();
            let (q, qd) = (&self.q[at.clone()], &self.qd[at]);
            for i in 1..=stretch.group.rows {
                let inverse_r = Wide::load(simd, &stretch.inverse_r[i]);
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
