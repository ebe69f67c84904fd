//! Combinations of slopes, eight numbers side by side: the motion at a stage, and the squares of error estimates.

use super::Stages;
use super::tableau::{Combination, STAGES};
use crate::integrate::field::Field;
use crate::linalg::eight::{F8, Wide, vector_unit};
use crate::threads;
use pulp::{Simd, WithSimd};

/// Work for one thread [blocks]: some 20 µs, a hundred times the cost of handing it over.
const SHARE: usize = 4096;

/// Writes the motion at one combination of the slopes: `out_q` and `out_qd`.
pub(super) struct Combine<'a> {
    pub(super) weights: &'a Combination,
    pub(super) h: f64,
    pub(super) q: &'a [F8],
    pub(super) qd: &'a [F8],
    pub(super) slope: &'a [Vec<F8>],
    /// Block of each slope that belongs to the first block of q.
    pub(super) first: usize,
    pub(super) out_q: &'a mut [F8],
    pub(super) out_qd: &'a mut [F8],
}

impl WithSimd for Combine<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Most tableaux have many zeros; the other terms are gathered.
        let mut terms: [Term<'_>; STAGES] = [(&[], 0.0, 0.0); STAGES];
        let mut count = 0;
        for (j, slope) in self.slope.iter().enumerate() {
            let (position, velocity) = (self.weights.position[j], self.weights.velocity[j]);
            if position != 0.0 || velocity != 0.0 {
                terms[count] = (&slope[self.first..], self.h * self.h * position, self.h * velocity);
                count += 1;
            }
        }
        // With their number known at compile time, the loop over them is unrolled.
        macro_rules! of {
            ($($n:literal)*) => {
                match count {
                    $($n => self.sum::<S, $n>(simd, std::array::from_fn(|j| terms[j])),)*
                    _ => self.sum::<S, STAGES>(simd, terms),
                }
            };
        }
        of!(0 1 2 3 4 5 6 7 8 9 10 11)
    }
}

/// A slope with its weights in positions and in velocities.
type Term<'a> = (&'a [F8], f64, f64);

impl Combine<'_> {
    /// On several threads where there are many blocks.
    #[inline(never)]
    pub(super) fn write(self) {
        let half = self.q.len() / 2;
        if half < SHARE {
            return vector_unit().dispatch(self);
        }
        let Combine { weights, h, q, qd, slope, first, out_q, out_qd } = self;
        let ((q, rest_q), (qd, rest_qd)) = (q.split_at(half), qd.split_at(half));
        let ((out_q, rest_out_q), (out_qd, rest_out_qd)) = (out_q.split_at_mut(half), out_qd.split_at_mut(half));
        let one = Combine { weights, h, q, qd, slope, first, out_q, out_qd };
        let first = first + half;
        let (out_q, out_qd) = (rest_out_q, rest_out_qd);
        let other = Combine { weights, h, q: rest_q, qd: rest_qd, slope, first, out_q, out_qd };
        threads::both(|| one.write(), || other.write());
    }

    #[inline(always)]
    fn sum<S: Simd, const N: usize>(self, simd: S, terms: [Term<'_>; N]) {
        let blocks = self.q.len();
        let terms = terms.map(|(slope, position, velocity)| (&slope[..blocks], position, velocity));
        let (qd, out_q, out_qd) = (&self.qd[..blocks], &mut self.out_q[..blocks], &mut self.out_qd[..blocks]);
        let hc = self.h * self.weights.c;
        for k in 0..blocks {
            let v = Wide::load(simd, &qd[k]);
            let (mut position, mut velocity) = (hc * v, Wide::splat(simd, 0.0));
            for (slope, in_position, in_velocity) in terms {
                let slope = Wide::load(simd, &slope[k]);
                position = position + in_position * slope;
                velocity = velocity + in_velocity * slope;
            }
            (Wide::load(simd, &self.q[k]) + position).store(&mut out_q[k]);
            (v + velocity).store(&mut out_qd[k]);
        }
    }
}

/// Σ |e|² of positions and of velocities for two estimates at once, over the coordinates that the field counts.
pub(in crate::integrate) struct Squares<'a, F> {
    pub(in crate::integrate) estimates: [&'a Combination; 2],
    pub(in crate::integrate) field: &'a F,
    pub(in crate::integrate) stages: &'a Stages,
    pub(in crate::integrate) h: f64,
}

impl<F: Field> WithSimd for Squares<'_, F> {
    type Output = [f64; 4];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 4] {
        let Squares { estimates: [fine, coarse], field, stages: Stages { qd, slope, .. }, h } = self;
        let mut terms: [(&[F8], [f64; 4]); STAGES] = [(&[], [0.0; 4]); STAGES];
        let mut count = 0;
        for (j, slope) in slope.iter().enumerate() {
            let weights = [h * fine.position[j], fine.velocity[j], h * coarse.position[j], coarse.velocity[j]];
            if weights != [0.0; 4] {
                terms[count] = (&slope[..qd.len()], weights);
                count += 1;
            }
        }
        let mut sums = [Wide::splat(simd, 0.0); 4];
        for k in 0..qd.len() {
            let v = Wide::load(simd, &qd[k]);
            let mut e = [fine.c * v, Wide::splat(simd, 0.0), coarse.c * v, Wide::splat(simd, 0.0)];
            for (slope, weights) in &terms[..count] {
                let slope = Wide::load(simd, &slope[k]);
                for (e, weight) in e.iter_mut().zip(weights) {
                    *e = *e + *weight * slope;
                }
            }
            let counted = Wide::load(simd, &field.counted(k));
            for (sum, e) in sums.iter_mut().zip(e) {
                *sum = *sum + counted * (e * e);
            }
        }
        sums.map(Wide::stored).map(F8::sum)
    }
}

/// Σ |Δ|² of positions and of velocities from the motion that was kept to the one that is tried, over the coordinates
/// that the field counts.
pub(super) struct Moved<'a, F> {
    pub(super) field: &'a F,
    pub(super) stages: &'a Stages,
}

impl<F: Field> WithSimd for Moved<'_, F> {
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let Stages { next_q, next_qd, stage_q, stage_qd, .. } = self.stages;
        let mut sums = [Wide::splat(simd, 0.0); 2];
        for k in 0..next_q.len() {
            let counted = Wide::load(simd, &self.field.counted(k));
            for (sum, [to, from]) in sums.iter_mut().zip([[&next_q[k], &stage_q[k]], [&next_qd[k], &stage_qd[k]]]) {
                let moved = Wide::load(simd, to) - Wide::load(simd, from);
                *sum = *sum + counted * (moved * moved);
            }
        }
        sums.map(Wide::stored).map(F8::sum)
    }
}
