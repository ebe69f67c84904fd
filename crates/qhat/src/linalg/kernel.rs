//! The dense work of a front on tiles of eight rows by four columns.
//!
//! Every number is a sum over k in ascending order, and each product is rounded before it is added. The results
//! therefore do not depend on how many numbers a register holds. `pulp` picks the widest registers of the machine at
//! run time.

use super::eight::{Eight, LANES};

/// Rows of a tile.
pub(crate) const H: usize = LANES;

/// Columns of a tile.
pub(crate) const COLUMNS: usize = 4;

/// Σ_k l[k] w[k]ᵀ, for the four columns of w from column C on.
#[inline(always)]
pub(crate) fn outer<const C: usize>(l: &[Eight], w: &[Eight]) -> [Eight; COLUMNS] {
    let mut sum = [[0.0; H]; COLUMNS];
    for (l, w) in l.iter().zip(w) {
        for j in 0..COLUMNS {
            for i in 0..H {
                sum[j][i] += l[i] * w[C + j];
            }
        }
    }
    sum
}

/// Σ_k l[k] x[k].
#[inline(always)]
pub(crate) fn rows(l: &[Eight], x: &[f64]) -> Eight {
    let mut sum = [0.0; H];
    for (l, &x) in l.iter().zip(x) {
        for i in 0..H {
            sum[i] += l[i] * x;
        }
    }
    sum
}

/// sum[k] += l[k] x lane by lane, for every k.
#[inline(always)]
pub(crate) fn columns(l: &[Eight], x: &Eight, sum: &mut [Eight]) {
    for (l, sum) in l.iter().zip(sum) {
        *sum = std::array::from_fn(|i| sum[i] + l[i] * x[i]);
    }
}

/// a −= b.
#[inline(always)]
pub(crate) fn subtract(a: &mut Eight, b: &Eight) {
    *a = std::array::from_fn(|i| a[i] - b[i]);
}

/// a − b c.
#[inline(always)]
pub(crate) fn minus_scaled(a: &Eight, b: &Eight, c: f64) -> Eight {
    std::array::from_fn(|i| a[i] - b[i] * c)
}

/// a c.
#[inline(always)]
pub(crate) fn scaled(a: &Eight, c: f64) -> Eight {
    a.map(|a| a * c)
}
