//! Eight numbers that go through the same arithmetic side by side: [`F8`] in memory, [`Wide`] in registers.
//!
//! Every operation acts on each number as on a single f64 and rounds once. The bits therefore do not depend on the
//! width of the vector unit, which is chosen when the program runs.

use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number of lanes: one register of AVX-512, two of AVX2, four of wasm.
pub(crate) const LANES: usize = 8;

/// Eight numbers without an alignment of their own: one column of a tile of eight rows.
pub(crate) type Eight = [f64; LANES];

/// One number in each lane, aligned to a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct F8(pub(crate) Eight);

impl F8 {
    pub(crate) const ZERO: F8 = F8([0.0; LANES]);

    pub(crate) fn splat(value: f64) -> F8 {
        F8([value; LANES])
    }

    /// Moves the value of every lane to the next lane, and the value of the last lane to the first.
    #[inline(always)]
    pub(crate) fn shifted_up(self) -> F8 {
        F8(std::array::from_fn(|k| self.0[(k + LANES - 1) % LANES]))
    }

    /// Moves the value of every lane to the lane before it, and the value of the first lane to the last.
    #[inline(always)]
    pub(crate) fn shifted_down(self) -> F8 {
        F8(std::array::from_fn(|k| self.0[(k + 1) % LANES]))
    }

    /// The sum over the lanes.
    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        across(&self.0)
    }

    /// max over the lanes; NaN if any lane is NaN.
    pub(crate) fn largest(self) -> f64 {
        self.0.into_iter().fold(0.0, |most: f64, x| if x > most || x.is_nan() { x } else { most })
    }
}

/// The sum over the lanes, always in the same order of additions.
#[inline(always)]
pub(crate) fn across(x: &Eight) -> f64 {
    ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
}

/// The widest vector unit of this machine; in the browser the vector unit that the page was built for.
#[inline(always)]
pub(crate) fn vector_unit() -> Arch {
    Arch::new()
}

/// Size below which a number that elimination lets decay from row to row is set to zero [SI units]. In a chain of a
/// thousand links such numbers would fall below 1e-308, where processors are a hundred times slower. The square of this
/// limit is still a normal number.
const NEGLIGIBLE: f64 = 1e-140;

/// Eight numbers in as many registers as the vector unit needs. `S` is that unit.
#[derive(Clone, Copy)]
pub(crate) struct Wide<S: Simd> {
    simd: S,
    /// The first 8/width registers are in use; the others are never read.
    parts: [S::f64s; LANES],
}

impl<S: Simd> Wide<S> {
    const PARTS: usize = LANES / S::F64_LANES;

    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Wide { simd, parts: [simd.splat_f64s(value); LANES] }
    }

    #[inline(always)]
    pub(crate) fn load(simd: S, from: &F8) -> Self {
        let (from, _) = S::as_simd_f64s(&from.0);
        let mut parts = [from[0]; LANES];
        parts[..Self::PARTS].copy_from_slice(&from[..Self::PARTS]);
        Wide { simd, parts }
    }

    #[inline(always)]
    pub(crate) fn store(self, to: &mut F8) {
        let (to, _) = S::as_mut_simd_f64s(&mut to.0);
        to[..Self::PARTS].copy_from_slice(&self.parts[..Self::PARTS]);
    }

    #[inline(always)]
    pub(crate) fn stored(self) -> F8 {
        let mut stored = F8::ZERO;
        self.store(&mut stored);
        stored
    }

    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(S, S::f64s, S::f64s) -> S::f64s) -> Self {
        for j in 0..Self::PARTS {
            self.parts[j] = f(self.simd, self.parts[j], other.parts[j]);
        }
        self
    }

    #[inline(always)]
    pub(crate) fn abs(mut self) -> Self {
        for j in 0..Self::PARTS {
            self.parts[j] = self.simd.abs_f64s(self.parts[j]);
        }
        self
    }

    /// The larger of each pair; NaN if either number is NaN.
    #[inline(always)]
    pub(crate) fn larger(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |simd, a, b| {
                // a where a ≥ b, else b; b where b is NaN. The second select keeps a where a is NaN.
                let keep = simd.select_f64s(simd.greater_than_or_equal_f64s(a, b), a, b);
                simd.select_f64s(simd.equal_f64s(a, a), keep, a)
            },
        )
    }

    /// `self`, with every number below `NEGLIGIBLE` set to zero.
    #[inline(always)]
    pub(crate) fn flushed(mut self) -> Self {
        let simd = self.simd;
        let (zero, negligible) = (simd.splat_f64s(0.0), simd.splat_f64s(NEGLIGIBLE));
        for part in &mut self.parts[..Self::PARTS] {
            *part = simd.select_f64s(simd.less_than_f64s(simd.abs_f64s(*part), negligible), zero, *part);
        }
        self
    }

    /// `self` where x > limit, else `other`; where x is NaN, `other`.
    #[inline(always)]
    pub(crate) fn where_above(mut self, x: Self, limit: Self, other: Self) -> Self {
        for j in 0..Self::PARTS {
            let is_above = self.simd.greater_than_f64s(x.parts[j], limit.parts[j]);
            self.parts[j] = self.simd.select_f64s(is_above, self.parts[j], other.parts[j]);
        }
        self
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $of_simd:ident) => {
        impl<S: Simd> $trait for Wide<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(
                    other,
                    #[inline(always)]
                    |simd, a, b| simd.$of_simd(a, b),
                )
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Mul<Wide<S>> for f64 {
    type Output = Wide<S>;
    #[inline(always)]
    fn mul(self, other: Wide<S>) -> Wide<S> {
        Wide::splat(other.simd, self) * other
    }
}

impl<S: Simd> Neg for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for j in 0..Self::PARTS {
            self.parts[j] = self.simd.neg_f64s(self.parts[j]);
        }
        self
    }
}

/// max |x| of a whole array; NaN if any number is NaN.
pub(crate) struct Largest<'a>(pub(crate) &'a [F8]);

impl WithSimd for Largest<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let mut largest = Wide::splat(simd, 0.0);
        for x in self.0 {
            largest = largest.larger(Wide::load(simd, x).abs());
        }
        largest.stored().largest()
    }
}

/// The D components of one block.
#[inline(always)]
pub(crate) fn load<S: Simd, const D: usize>(simd: S, flat: &[F8], block: usize) -> [Wide<S>; D] {
    std::array::from_fn(
        #[inline(always)]
        |c| Wide::load(simd, &flat[block * D + c]),
    )
}

/// a − b.
#[inline(always)]
pub(crate) fn minus<S: Simd, const D: usize>(a: [Wide<S>; D], b: [Wide<S>; D]) -> [Wide<S>; D] {
    std::array::from_fn(
        #[inline(always)]
        |c| a[c] - b[c],
    )
}

/// a · b, summed in ascending order of the components.
#[inline(always)]
pub(crate) fn dot<S: Simd, const D: usize>(a: [Wide<S>; D], b: [Wide<S>; D]) -> Wide<S> {
    let mut sum = a[0] * b[0];
    for c in 1..D {
        sum = sum + a[c] * b[c];
    }
    sum
}
