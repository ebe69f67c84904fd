//! Numbers that may carry a derivative, and vectors of them. A formula written once over them gives values, and with
//! [`Dual`] the rates of these values, too.
//!
//! ```text
//! x + ẋ ε with ε² = 0:   f(x + ẋ ε) = f(x) + f'(x) ẋ ε
//! ```
//!
//! `hyper/` has numbers that carry second derivatives.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The larger of two numbers; not a number if one of them is not. `f64::max` would leave that one out, and a maximum of
/// errors would hide the worst.
///
/// ```
/// # use qhat::larger;
/// let errors = [1e-3, f64::NAN, 2e-3];
/// assert!(errors.into_iter().fold(0.0, larger).is_nan());
/// assert_eq!(errors.into_iter().fold(0.0, f64::max), 2e-3);
/// ```
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a >= b || a.is_nan() { a } else { b }
}

/// A real number, alone or with a derivative.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A constant: its derivative is 0.
    fn constant(value: f64) -> Self;
    /// The number without its derivative.
    fn value(self) -> f64;
    /// The derivative; 0 for a plain number.
    fn slope(self) -> f64;
    /// f(x), of a function whose value and derivative at x are given.
    fn with(self, f: f64, derivative: f64) -> Self;

    /// s x.
    fn times(self, s: f64) -> Self {
        Self::constant(s) * self
    }

    /// √x, with an infinite derivative at 0.
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.with(root, 0.5 / root)
    }

    /// The angle of (x, y) from the first axis, in (−π, π] [rad].
    fn atan2(y: Self, x: Self) -> Self {
        let (r, angle) = (x.value() * x.value() + y.value() * y.value(), libm::atan2(y.value(), x.value()));
        // dθ = (x dy − y dx)/r²
        Self::of(angle, (x.value() * y.slope() - y.value() * x.slope()) / r)
    }

    /// The number with this value and this derivative.
    fn of(value: f64, slope: f64) -> Self;
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn slope(self) -> f64 {
        0.0
    }
    fn with(self, f: f64, _: f64) -> Self {
        f
    }
    fn of(value: f64, _: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}

/// x + ẋ ε.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) slope: f64,
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        Dual { value, slope: 0.0 }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn slope(self) -> f64 {
        self.slope
    }
    fn with(self, f: f64, derivative: f64) -> Self {
        Dual { value: f, slope: derivative * self.slope }
    }
    fn of(value: f64, slope: f64) -> Self {
        Dual { value, slope }
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Dual {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        Dual { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl Div for Dual {
    type Output = Dual;
    fn div(self, other: Dual) -> Dual {
        let value = self.value / other.value;
        Dual { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual { value: -self.value, slope: -self.slope }
    }
}

/// a · b, summed from the first component on.
#[inline(always)]
pub(crate) fn dot<N: Number, const D: usize>(a: [N; D], b: [N; D]) -> N {
    let mut sum = a[0] * b[0];
    for k in 1..D {
        sum = sum + a[k] * b[k];
    }
    sum
}

/// a − b.
#[inline(always)]
pub(crate) fn minus<N: Number, const D: usize>(a: [N; D], b: [N; D]) -> [N; D] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// a + b.
#[inline(always)]
pub(crate) fn plus<N: Number, const D: usize>(a: [N; D], b: [N; D]) -> [N; D] {
    std::array::from_fn(|k| a[k] + b[k])
}

/// s a.
#[inline(always)]
pub(crate) fn scaled<N: Number, const D: usize>(s: N, a: [N; D]) -> [N; D] {
    std::array::from_fn(|k| s * a[k])
}

/// a × b, in three dimensions.
#[inline(always)]
pub(crate) fn cross<N: Number, const D: usize>(a: [N; D], b: [N; D]) -> [N; D] {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

/// |a|.
#[inline(always)]
pub(crate) fn norm<N: Number, const D: usize>(a: [N; D]) -> N {
    dot(a, a).sqrt()
}

/// A vector of the plane as one of space, with z = 0; a vector of space unchanged.
pub(crate) fn raised<N: Number, const D: usize>(a: [N; D]) -> [N; 3] {
    std::array::from_fn(|k| if k < D { a[k] } else { N::constant(0.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation against the quotient of differences.
    #[test]
    fn slopes_are_derivatives() {
        fn f<N: Number>(x: N, y: N) -> N {
            let r = (x * x + y * y).sqrt();
            N::atan2(y - x / r, x * y.times(3.0) + N::constant(2.0)) / r - (-x) * y
        }
        let (x, y, dx, dy) = (0.7, -1.3, 0.4, 0.9);
        let dual = f(Dual { value: x, slope: dx }, Dual { value: y, slope: dy });
        let h = 1e-5;
        let difference = (f(x + h * dx, y + h * dy) - f(x - h * dx, y - h * dy)) / (2.0 * h);
        assert_eq!(dual.value, f(x, y));
        // Central differences at this h are good to h² and ε/h, 1e-10 each.
        assert!((dual.slope - difference).abs() < 1e-9, "{} {difference}", dual.slope);
    }
}
