//! Hyper-dual numbers: a value with its derivatives along two directions and the mixed second derivative.
//!
//! ```text
//! x + x_a ε₁ + x_b ε₂ + x_ab ε₁ε₂   with ε₁² = ε₂² = 0
//! f(x):      f_a = f' x_a,                f_ab = f' x_ab + f" x_a x_b
//! f(x, y):   f_a = f_x x_a + f_y y_a
//!            f_ab = f_x x_ab + f_y y_ab + f_xx x_a x_b + f_xy (x_a y_b + x_b y_a) + f_yy y_a y_b
//! ```
//!
//! One formula over these numbers gives every derivative that the engine needs, to roundoff (Fike and Alonso, 2011).
//! f', f", f_x and the others come from the operations of expressions. So a function of a user in Rust and the same
//! function as text have the same derivatives, and the same bits on every target.

mod derivatives;
mod operators;

pub(crate) use derivatives::{gradient, hessian_blocks, jet};

use crate::expression::{MAX_PRODUCT, Operation};

/// A number with its derivatives along two directions and the mixed second derivative: the number type of
/// [`CustomConstraint`] and [`CustomPotential`].
///
/// It has +, −, × and ÷ with other such numbers and with `f64`, and the functions below. [`with`](Hyper::with) makes
/// any other function from its value and its first two derivatives. Where a derivative is infinite (√0) or undefined,
/// so is that of the result, and the step ends in an error.
///
/// ```
/// use qhat::Hyper;
///
/// /// sinh x; its derivatives are cosh x and sinh x.
/// fn sinh(x: Hyper) -> Hyper {
///     let e = x.exp().value();
///     let (sinh, cosh) = ((e - 1.0 / e) / 2.0, (e + 1.0 / e) / 2.0);
///     x.with(sinh, cosh, sinh)
/// }
/// assert_eq!(sinh(0.0.into()).value(), 0.0);
/// ```
///
/// [`CustomConstraint`]: crate::CustomConstraint
/// [`CustomPotential`]: crate::CustomPotential
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hyper {
    value: f64,
    /// The derivative along the first direction.
    a: f64,
    /// The derivative along the second direction.
    b: f64,
    /// The derivative along both.
    ab: f64,
}

impl From<f64> for Hyper {
    fn from(value: f64) -> Self {
        Hyper { value, ..Hyper::default() }
    }
}

impl Hyper {
    /// The number without its derivatives: to choose between two formulas.
    pub fn value(self) -> f64 {
        self.value
    }

    /// f(x), of a function whose value f, first derivative f' and second derivative f" at x = `self.value()` are given.
    pub fn with(self, f: f64, first: f64, second: f64) -> Self {
        Hyper { value: f, a: first * self.a, b: first * self.b, ab: first * self.ab + second * self.a * self.b }
    }

    /// √x. At 0 its derivative is infinite.
    pub fn sqrt(self) -> Self {
        self.apply(Operation::SquareRoot)
    }

    /// |x|, with the derivative 1 at 0.
    pub fn abs(self) -> Self {
        self.apply(Operation::Absolute)
    }

    /// sin x, of x in radians.
    pub fn sin(self) -> Self {
        self.apply(Operation::Sine)
    }

    /// cos x, of x in radians.
    pub fn cos(self) -> Self {
        self.apply(Operation::Cosine)
    }

    /// tan x, of x in radians.
    pub fn tan(self) -> Self {
        self.apply(Operation::Tangent)
    }

    /// The angle in [−π/2, π/2] whose sine is x.
    pub fn asin(self) -> Self {
        self.apply(Operation::ArcSine)
    }

    /// The angle in [0, π] whose cosine is x.
    pub fn acos(self) -> Self {
        self.apply(Operation::ArcCosine)
    }

    /// The angle in (−π/2, π/2) whose tangent is x.
    pub fn atan(self) -> Self {
        self.apply(Operation::ArcTangent)
    }

    /// The angle of the point (x, `self`) from the first axis, in (−π, π]: `y.atan2(x)`.
    pub fn atan2(self, x: impl Into<Hyper>) -> Self {
        self.combine(Operation::Angle, x.into())
    }

    /// eˣ.
    pub fn exp(self) -> Self {
        self.apply(Operation::Exponential)
    }

    /// The natural logarithm of x.
    pub fn ln(self) -> Self {
        self.apply(Operation::Logarithm)
    }

    /// √(x² + y²). At (0, 0) it has no derivative.
    pub fn hypot(self, y: impl Into<Hyper>) -> Self {
        let y = y.into();
        (self * self + y * y).sqrt()
    }

    /// xⁿ, by multiplication.
    pub fn powi(self, n: i32) -> Self {
        let mut power = Hyper::from(1.0);
        // Bits of |n| from the highest on: square, and multiply where the bit is set.
        for bit in (0..32).rev().skip_while(|bit| n.unsigned_abs() >> bit == 0) {
            power = power * power;
            if n.unsigned_abs() >> bit & 1 == 1 {
                power *= self;
            }
        }
        if n < 0 { 1.0 / power } else { power }
    }

    /// xᵖ for a constant exponent p. A whole p is [`powi`](Hyper::powi), which has its derivatives at x ≤ 0, too.
    pub fn powf(self, p: f64) -> Self {
        // Up to this exponent a power is a product, as in expressions.
        if p == p.trunc() && p.abs() <= MAX_PRODUCT {
            return self.powi(p as i32);
        }
        self.combine(Operation::PowerOf, p.into())
    }

    /// f(x).
    fn apply(self, operation: Operation) -> Self {
        let f = operation.value(self.value, 0.0);
        let slopes = operation.first(self.value, 0.0, f);
        let [second, ..] = operation.second(self.value, 0.0, f, slopes);
        self.with(f, slopes[0], second)
    }

    /// f(x, y).
    fn combine(self, operation: Operation, other: Hyper) -> Self {
        let (x, y) = (self, other);
        let f = operation.value(x.value, y.value);
        let slopes = operation.first(x.value, y.value, f);
        let [f_xx, f_xy, f_yy] = operation.second(x.value, y.value, f, slopes);
        let [f_x, f_y] = slopes;
        let bends = f_xx * x.a * x.b + f_xy * (x.a * y.b + x.b * y.a) + f_yy * y.a * y.b;
        Hyper { value: f, a: f_x * x.a + f_y * y.a, b: f_x * x.b + f_y * y.b, ab: f_x * x.ab + f_y * y.ab + bends }
    }
}

#[cfg(test)]
mod tests;
