//! Driven: a number that may change with time, such as the length of a driven rod or the angle of a crank.

use crate::allowed::{ValueError, finite};
use crate::expression::{Expression, ExpressionError, Purpose, Scope};
use crate::number::Number;
use crate::space::Dimension;

/// A number, or a function of t alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Driven {
    /// A fixed number.
    Constant(f64),
    /// An expression that depends on t \[s\] alone.
    Function(Expression),
}

impl Driven {
    /// s and ṡ at t. If t carries a derivative, they carry theirs: ṡ and s̈.
    pub(crate) fn at<N: Number>(&self, t: N) -> (N, N) {
        match self {
            Driven::Constant(value) => (N::constant(*value), N::constant(0.0)),
            Driven::Function(function) => {
                let jet = function.jet(&[], &[], t.value());
                (t.with(jet.value, jet.first), t.with(jet.first, jet.second))
            }
        }
    }

    /// A function of t \[s\] from its text, as in `"2*pi*t"`.
    ///
    /// ```
    /// use qhat::Driven;
    /// let angle = Driven::text("pi/2 + 2*pi*t")?;
    /// assert!((angle.value(0.25) - std::f64::consts::PI).abs() < 1e-15);
    /// # Ok::<(), qhat::ExpressionError>(())
    /// ```
    ///
    /// # Errors
    /// A text that is no expression of `t`, with the place that is wrong.
    pub fn text(text: &str) -> Result<Self, ExpressionError> {
        // A function of time alone is the same in any number of dimensions.
        let scope = Scope::new(Purpose::Time, Dimension::Two, &|_| None);
        Expression::parse(text, &scope).map(Driven::Function)
    }

    /// Whether it is a function of t.
    pub(crate) fn is_driven(&self) -> bool {
        matches!(self, Driven::Function(_))
    }

    /// Its value at t \[s\].
    pub fn value(&self, t: f64) -> f64 {
        self.at(t).0
    }

    /// `Ok` if it is a finite number at the start, and a function of time alone.
    pub(crate) fn check(&self, what: &'static str) -> Result<(), ValueError> {
        if let Driven::Function(function) = self
            && (!function.particles().is_empty() || function.uses_velocities())
        {
            return Err(ValueError::NamesParticles { what, expression: function.text().to_owned() });
        }
        finite(what, self.value(0.0))
    }
}

impl From<f64> for Driven {
    fn from(value: f64) -> Self {
        Driven::Constant(value)
    }
}

impl From<Expression> for Driven {
    fn from(function: Expression) -> Self {
        Driven::Function(function)
    }
}

impl TryFrom<&str> for Driven {
    type Error = ExpressionError;

    fn try_from(text: &str) -> Result<Self, ExpressionError> {
        Driven::text(text)
    }
}
