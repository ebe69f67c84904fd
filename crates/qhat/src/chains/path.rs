//! The multipliers of eight stretches of chain at once: assembly, factorization and solution of A λ = b in two sweeps.
//!
//! Row i of a stretch holds particles i − 1 and i at the distance r_i; d_i = x_i − x_{i−1}. In the half squared form C
//! = ½(d·d − r²), J and γ contain neither a root nor a quotient, and q̈ on C = Ċ = 0 is the same as in the length form:
//!
//! ```text
//! A_ii = (w_{i−1} + w_i) d_i·d_i,   A_{i,i−1} = e_i = −w_{i−1} d_{i−1}·d_i        [1/kg · m²]
//! D_i = A_ii − e_i²/D_{i−1},   y_i = b_i − e_i y_{i−1}/D_{i−1}                    forward
//! λ_i = (y_i − e_{i+1} λ_{i+1})/D_i,   W Jᵀλ at i = w_i (λ_i d_i − λ_{i+1} d_{i+1})   backward
//! ```
//!
//! A division takes longer than all other operations of a row, and D_i would wait for the division of D_{i−1}. Written
//! as D_i = p_i/p_{i−1} with p_i = A_ii p_{i−1} − e_i² p_{i−2}, the recurrence multiplies and subtracts only. Only p is
//! passed from row to row, and the divisions no longer wait for each other.
//!
//! Eight lanes may hold consecutive stretches of one long chain. Row 1 of a lane is then coupled with the last row of
//! the lane before, whose multiplier z is not known yet. Its coefficients are carried along as a second right-hand
//! side, f_1 = e_1 and f_i = −e_i f_{i−1}/D_{i−1}. A system with one unknown for each lane remains, tridiagonal again
//! (elimination by partition):
//!
//! ```text
//! (D_S − Σ' f²/D) z_lane + f_S z_before + f'_S z_after = y_S − Σ' f y/D      ' : rows below S of the lane after
//! λ_i = (y_i − f_i z − e_{i+1} λ_{i+1})/D_i
//! ```
//!
//! Source: Baraff, Linear-Time Dynamics using Lagrange Multipliers (1996), for the elimination; Wang, A parallel method
//! for tridiagonal equations, ACM TOMS 7 (1981), for the partition.

use crate::linalg::eight::{F8, LANES, Wide, dot, load, minus};
use crate::structure::chains::{Group, Stretch};
use pulp::Simd;

/// Rows after which the product p of all pivots starts again from one, before p can overflow or underflow. Numbers that
/// have decayed below `NEGLIGIBLE` are set to zero at the same row.
const RESTART: usize = 4;

/// One row after the forward sweep.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Eliminated {
    /// e_i.
    e: F8,
    /// 1/D_i.
    inverse: F8,
    /// y_i.
    y: F8,
    /// f_i.
    f: F8,
}

/// The right-hand side of A λ = b and the vector to which W Jᵀλ is added. Blocks are counted from the group's first
/// block.
pub(super) trait RightSide<const D: usize> {
    /// b of row i.
    fn row<S: Simd>(&self, simd: S, i: usize, d: [Wide<S>; D]) -> Wide<S>;

    /// The value of block i without any constraint.
    fn free<S: Simd>(&self, simd: S, i: usize) -> [Wide<S>; D];
}

/// Writes free + W Jᵀλ with A λ = b into `out`. All slices begin at the group's first block. Returns false if a pivot
/// is below the part `tiny` of its diagonal, or NaN: the rows nearly depend on each other, and `out` must not be used.
#[inline(always)]
pub(super) fn solve<S: Simd, const D: usize>(
    simd: S,
    stretch: Stretch<'_>,
    q: &[F8],
    right: &impl RightSide<D>,
    rows: &mut [Eliminated],
    out: &mut [F8],
    tiny: f64,
) -> bool {
    if stretch.group.rows == 0 {
        for (c, free) in right.free(simd, 0).into_iter().enumerate() {
            free.store(&mut out[c]);
        }
        true
    } else if stretch.group.is_coupled {
        sweep::<S, D, true>(simd, stretch, q, right, rows, out, tiny)
    } else {
        sweep::<S, D, false>(simd, stretch, q, right, rows, out, tiny)
    }
}

#[inline(always)]
fn sweep<S: Simd, const D: usize, const COUPLED: bool>(
    simd: S,
    Stretch { group, w, rod, padding, .. }: Stretch<'_>,
    q: &[F8],
    right: &impl RightSide<D>,
    rows: &mut [Eliminated],
    out: &mut [F8],
    tiny: f64,
) -> bool {
    let last = group.rows;
    // Slices of known length, so that the compiler drops the bounds checks below.
    let (w, rod, padding, rows) = (&w[..=last], &rod[..=last], &padding[..=last], &mut rows[..=last]);
    let (q, out) = (&q[..(last + 1) * D], &mut out[..(last + 1) * D]);
    let at = |number: &F8| Wide::load(simd, number);
    let (zero, one) = (Wide::splat(simd, 0.0), Wide::splat(simd, 1.0));
    let follows = at(&group.follows);

    let mut x = load::<S, D>(simd, q, 0);
    let mut d_before = [zero; D];
    if COUPLED {
        let tail = minus(load::<S, D>(simd, q, last), load(simd, q, last - 1));
        d_before = tail.map(
            #[inline(always)]
            |d| at(&(at(&rod[last]) * d).stored().shifted_up()),
        );
    }
    let (mut inverse, mut y, mut f) = (zero, zero, zero);
    let (mut p_before, mut p) = (zero, one);
    let (mut tail_square, mut tail_y) = (zero, zero);
    let mut regular = one;
    let mut w_before = at(&w[0]);
    for i in 1..=last {
        let x_here = load::<S, D>(simd, q, i);
        let w_here = at(&w[i]);
        let is_rod = at(&rod[i]);
        let d = minus(x_here, x).map(
            #[inline(always)]
            |d| is_rod * d,
        );
        let diagonal = (w_before + w_here) * dot(d, d) + at(&padding[i]);
        let e = -(w_before * dot(d_before, d));
        let p_here = diagonal * p - (e * e) * p_before;
        regular = regular.where_above(p_here, tiny * (diagonal * p), zero);
        let ratio = e * inverse;
        y = right.row(simd, i, d) - ratio * y;
        if COUPLED {
            // The multiplier of the lane before is not known in row 1; its coefficient is f.
            f = if i == 1 { follows * e } else { -(ratio * f) };
        }
        inverse = p / p_here;
        (p_before, p) = (p, p_here);
        if i % RESTART == 0 {
            (y, f) = (y.flushed(), f.flushed());
            (p_before, p) = (inverse, one);
        }
        if COUPLED && i < last {
            let scaled = f * inverse;
            tail_square = tail_square + f * scaled;
            tail_y = tail_y + y * scaled;
        }
        let row = &mut rows[i];
        e.store(&mut row.e);
        inverse.store(&mut row.inverse);
        y.store(&mut row.y);
        if COUPLED {
            f.store(&mut row.f);
        }
        (x, d_before, w_before) = (x_here, d, w_here);
    }

    let mut lambda = y * inverse;
    let mut z = zero;
    let mut is_regular = true;
    if COUPLED {
        let tails = Tails { y: y.stored(), inverse: inverse.stored(), f: f.stored() };
        let (separators, is_positive) = separators(group, &tails, tail_square.stored(), tail_y.stored(), tiny);
        is_regular = is_positive;
        lambda = at(&separators);
        z = (follows * at(&separators.shifted_up())).flushed();
    }

    // `pull` is λ d and `e_after` is e of the row after.
    let mut pull = [zero; D];
    let mut e_after = zero;
    for i in (1..=last).rev() {
        let row = &rows[i];
        let (e, inverse) = (at(&row.e), at(&row.inverse));
        if i < last {
            let known = if COUPLED { at(&row.y) - at(&row.f) * z } else { at(&row.y) };
            lambda = known * inverse - (e_after * inverse) * lambda;
        }
        if i % RESTART == 0 {
            lambda = lambda.flushed();
        }
        let x_before = load::<S, D>(simd, q, i - 1);
        let (w_here, is_rod) = (at(&w[i]), at(&rod[i]));
        let free = right.free(simd, i);
        let d = minus(x, x_before);
        for c in 0..D {
            let here = lambda * (is_rod * d[c]);
            (free[c] + w_here * (here - pull[c])).flushed().store(&mut out[i * D + c]);
            pull[c] = here;
        }
        (x, e_after) = (x_before, e);
    }
    let free = right.free(simd, 0);
    for c in 0..D {
        let own = free[c] - at(&w[0]) * pull[c];
        own.flushed().store(&mut out[c]);
        if COUPLED {
            let from_after = at(&(follows * pull[c]).stored().shifted_down());
            let tail = (at(&out[last * D + c]) - at(&w[last]) * from_after).flushed().stored();
            out[last * D + c] = tail;
            // The first particle of a lane that continues another is the last particle of the lane before.
            at(&tail.shifted_up()).where_above(follows, zero, own).store(&mut out[c]);
        }
    }
    is_regular && regular.stored().0.iter().all(|&lane| lane > 0.0)
}

/// The last row of every lane after the forward sweep.
struct Tails {
    y: F8,
    inverse: F8,
    f: F8,
}

/// The multipliers of the last row of every lane, and whether no pivot is tiny.
#[inline(always)]
fn separators(group: &Group, last: &Tails, tail_square: F8, tail_y: F8, tiny: f64) -> (F8, bool) {
    let follows = |k: usize| if k < LANES { group.follows.0[k] } else { 0.0 };
    let mut is_regular = true;
    let (mut y, mut inverse, mut f) = ([0.0; LANES], [0.0; LANES], [0.0; LANES + 1]);
    for k in 0..LANES {
        let after = (k + 1) % LANES;
        let diagonal = 1.0 / last.inverse.0[k];
        let mut pivot = diagonal - follows(k + 1) * tail_square.0[after];
        y[k] = last.y.0[k] - follows(k + 1) * tail_y.0[after];
        f[k] = follows(k) * last.f.0[k];
        if k > 0 {
            let ratio = f[k] * inverse[k - 1];
            pivot -= ratio * f[k];
            y[k] -= ratio * y[k - 1];
        }
        inverse[k] = 1.0 / pivot;
        is_regular &= pivot > tiny * diagonal;
    }
    let mut lambda = F8::ZERO;
    let mut after = 0.0;
    for k in (0..LANES).rev() {
        after = y[k] * inverse[k] - (f[k + 1] * inverse[k]) * after;
        lambda.0[k] = after;
    }
    (lambda, is_regular)
}
