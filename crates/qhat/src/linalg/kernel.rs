//! The dense work of a front on tiles of eight rows by four columns.
//!
//! Every number is a sum over k in ascending order, each product rounded before it is added: how many numbers a register holds
//! changes nothing. `pulp` picks the widest registers of the machine at run time.

/// Rows of a tile.
pub(crate) const H: usize = 8;

/// Columns of a tile.
pub(crate) const V: usize = 4;

/// One column of a block of eight rows.
pub(crate) type Lanes = [f64; H];

/// Σ_k l[k] w[k]ᵀ, where of the eight columns of w four are taken, from C on.
#[inline(always)]
pub(crate) fn outer<const C: usize>(l: &[Lanes], w: &[Lanes]) -> [Lanes; V] {
    let mut sum = [[0.0; H]; V];
    for (l, w) in l.iter().zip(w) {
        for j in 0..V {
            for i in 0..H {
                sum[j][i] += l[i] * w[C + j];
            }
        }
    }
    sum
}

/// Σ_k l[k] x[k].
#[inline(always)]
pub(crate) fn rows(l: &[Lanes], x: &[f64]) -> Lanes {
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
pub(crate) fn columns(l: &[Lanes], x: &Lanes, sum: &mut [Lanes]) {
    for (l, sum) in l.iter().zip(sum) {
        *sum = std::array::from_fn(|i| sum[i] + l[i] * x[i]);
    }
}

/// a −= b.
#[inline(always)]
pub(crate) fn subtract(a: &mut Lanes, b: &Lanes) {
    *a = std::array::from_fn(|i| a[i] - b[i]);
}

/// a − b c.
#[inline(always)]
pub(crate) fn minus_scaled(a: &Lanes, b: &Lanes, c: f64) -> Lanes {
    std::array::from_fn(|i| a[i] - b[i] * c)
}

/// a c.
#[inline(always)]
pub(crate) fn scaled(a: &Lanes, c: f64) -> Lanes {
    a.map(|a| a * c)
}

/// The sum over lanes, always in this tree.
#[inline(always)]
pub(crate) fn across(x: &Lanes) -> f64 {
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}
