//! Real and complex numbers as the entries of one factorization. Only the operations of an elimination exist.

use std::ops::{AddAssign, Mul, SubAssign};

/// A number that matrices can have as entries.
pub(crate) trait Scalar: Copy + Default + PartialEq + Mul<Output = Self> + AddAssign + SubAssign {
    /// A real number.
    fn real(x: f64) -> Self;

    /// 1/x.
    fn reciprocal(self) -> Self;

    /// |re| + |im|: between |x| and √2 |x|.
    fn size(self) -> f64;
}

impl Scalar for f64 {
    fn real(x: f64) -> Self {
        x
    }

    fn reciprocal(self) -> Self {
        1.0 / self
    }

    fn size(self) -> f64 {
        self.abs()
    }
}

/// re + i im.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Complex {
    pub(crate) re: f64,
    pub(crate) im: f64,
}

impl Mul for Complex {
    type Output = Complex;

    #[inline(always)]
    fn mul(self, other: Complex) -> Complex {
        Complex { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl AddAssign for Complex {
    #[inline(always)]
    fn add_assign(&mut self, other: Complex) {
        self.re += other.re;
        self.im += other.im;
    }
}

impl SubAssign for Complex {
    #[inline(always)]
    fn sub_assign(&mut self, other: Complex) {
        self.re -= other.re;
        self.im -= other.im;
    }
}

impl Scalar for Complex {
    fn real(x: f64) -> Self {
        Complex { re: x, im: 0.0 }
    }

    /// By the larger part, so that no square overflows (Smith, Algorithm 116, Comm. ACM 5 (1962)).
    fn reciprocal(self) -> Self {
        if self.re.abs() >= self.im.abs() {
            let ratio = self.im / self.re;
            let divisor = self.re + self.im * ratio;
            Complex { re: 1.0 / divisor, im: -ratio / divisor }
        } else {
            let ratio = self.re / self.im;
            let divisor = self.im + self.re * ratio;
            Complex { re: ratio / divisor, im: -1.0 / divisor }
        }
    }

    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reciprocals_are_right_where_squares_overflow() {
        let x = Complex { re: 3e200, im: -4e200 };
        let product = x * x.reciprocal();
        // A few roundings of numbers up to one.
        assert!((product.re - 1.0).abs() < 1e-15 && product.im.abs() < 1e-15, "{product:?}");
        let x = Complex { re: 0.0, im: 2.0 };
        assert_eq!(x.reciprocal(), Complex { re: 0.0, im: -0.5 });
    }
}
