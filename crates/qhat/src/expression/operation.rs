//! Operations on scalars: f(a, b) with its first and second partial derivatives.
//!
//! ```text
//! v = f(a, b)    f_a, f_b    f_aa, f_ab, f_bb
//! ```
//!
//! A function of one argument has f_b = f_ab = f_bb = 0. At a kink the active branch counts: of |a| the branch of a ≥
//! 0, of least and greatest that of the first argument where both are equal. An infinite (√0, acos 1) or undefined
//! derivative is returned as inf or NaN.
//!
//! Every number is computed in the order written, by `libm` where the operation is not one of IEEE 754, so that all
//! targets give the same bits.

/// An operation on one or two numbers. A function of one argument ignores b.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    /// a^b for a constant b.
    PowerOf,
    /// a^b.
    Power,
    SquareRoot,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    /// The angle of the point (b, a).
    Angle,
    Exponential,
    Logarithm,
    Absolute,
    Least,
    Greatest,
}

use Operation::*;

impl Operation {
    /// Whether the operation depends on b.
    #[inline(always)]
    pub(super) fn is_binary(self) -> bool {
        matches!(self, Add | Subtract | Multiply | Divide | PowerOf | Power | Angle | Least | Greatest)
    }

    /// Whether f(a, b) = f(b, a), to the bit.
    pub(super) fn commutes(self) -> bool {
        matches!(self, Add | Multiply)
    }

    /// f(a, b).
    #[inline(always)]
    pub(crate) fn value(self, a: f64, b: f64) -> f64 {
        match self {
            Add => a + b,
            Subtract => a - b,
            Multiply => a * b,
            Divide => a / b,
            Negate => -a,
            PowerOf | Power => libm::pow(a, b),
            SquareRoot => a.sqrt(),
            Sine => libm::sin(a),
            Cosine => libm::cos(a),
            Tangent => libm::tan(a),
            ArcSine => libm::asin(a),
            ArcCosine => libm::acos(a),
            ArcTangent => libm::atan(a),
            Angle => libm::atan2(a, b),
            Exponential => libm::exp(a),
            Logarithm => libm::log(a),
            Absolute => a.abs(),
            Least | Greatest => {
                if self.takes_first(a, b) {
                    a
                } else {
                    b
                }
            }
        }
    }

    /// Whether the active branch of least or greatest is a. NaN on either side gives NaN.
    #[inline(always)]
    pub(super) fn takes_first(self, a: f64, b: f64) -> bool {
        a.is_nan() || if self == Least { a <= b } else { a >= b }
    }

    /// [f_a, f_b], where v = f(a, b).
    #[inline(always)]
    pub(crate) fn first(self, a: f64, b: f64, v: f64) -> [f64; 2] {
        match self {
            Add => [1.0, 1.0],
            Subtract => [1.0, -1.0],
            Multiply => [b, a],
            Divide => [1.0 / b, -v / b],
            Negate => [-1.0, 0.0],
            PowerOf => [b * libm::pow(a, b - 1.0), 0.0],
            Power => [b * libm::pow(a, b - 1.0), times_logarithm(v, a)],
            SquareRoot => [0.5 / v, 0.0],
            Sine => [libm::cos(a), 0.0],
            Cosine => [-libm::sin(a), 0.0],
            Tangent => [1.0 + v * v, 0.0],
            ArcSine => [1.0 / ((1.0 - a) * (1.0 + a)).sqrt(), 0.0],
            ArcCosine => [-1.0 / ((1.0 - a) * (1.0 + a)).sqrt(), 0.0],
            ArcTangent => [1.0 / (1.0 + a * a), 0.0],
            Angle => {
                let r2 = a * a + b * b;
                [b / r2, -a / r2]
            }
            Exponential => [v, 0.0],
            Logarithm => [1.0 / a, 0.0],
            Absolute => [if a < 0.0 { -1.0 } else { 1.0 }, 0.0],
            Least | Greatest => {
                if self.takes_first(a, b) {
                    [1.0, 0.0]
                } else {
                    [0.0, 1.0]
                }
            }
        }
    }

    /// [f_aa, f_ab, f_bb], where v = f(a, b) and [f_a, f_b] are the first derivatives.
    #[inline(always)]
    pub(crate) fn second(self, a: f64, b: f64, v: f64, [f_a, f_b]: [f64; 2]) -> [f64; 3] {
        match self {
            Add | Subtract | Negate | Absolute | Least | Greatest => [0.0; 3],
            Multiply => [0.0, 1.0, 0.0],
            Divide => [0.0, -f_a / b, -2.0 * f_b / b],
            PowerOf => [b * (b - 1.0) * libm::pow(a, b - 2.0), 0.0, 0.0],
            Power => {
                let below = libm::pow(a, b - 1.0);
                let f_ab = below + times_logarithm(f_a, a);
                [b * (b - 1.0) * libm::pow(a, b - 2.0), f_ab, times_logarithm(f_b, a)]
            }
            SquareRoot => [-0.5 * f_a / a, 0.0, 0.0],
            Sine | Cosine => [-v, 0.0, 0.0],
            Tangent => [2.0 * v * f_a, 0.0, 0.0],
            ArcSine | ArcCosine => [a * f_a / ((1.0 - a) * (1.0 + a)), 0.0, 0.0],
            ArcTangent => [-2.0 * a * f_a * f_a, 0.0, 0.0],
            // f_a = b/r², f_b = −a/r²
            Angle => [2.0 * f_a * f_b, f_b * f_b - f_a * f_a, -2.0 * f_a * f_b],
            Exponential => [v, 0.0, 0.0],
            Logarithm => [-f_a * f_a, 0.0, 0.0],
        }
    }
}

/// s ln a, and 0 where s = 0: s vanishes with a power of a, and the product with it.
#[inline(always)]
fn times_logarithm(s: f64, a: f64) -> f64 {
    if s == 0.0 { 0.0 } else { s * libm::log(a) }
}
