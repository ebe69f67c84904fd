//! Driven: a number that may change with time, such as the length of a driven rod or the angle of a crank.

use crate::expression::Expression;
use crate::number::Number;

/// A number, or a function of t alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Driven {
    /// A fixed number.
    Constant(f64),
    /// An expression that depends on t [s] alone.
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

    /// The value at t [s].
    pub fn value(&self, t: f64) -> f64 {
        self.at(t).0
    }

    /// `Ok` if the value is finite at t = 0 and depends on time alone. `what` names the number in the message.
    pub(crate) fn check(&self, what: &str) -> Result<(), String> {
        if let Driven::Function(function) = self
            && (!function.particles().is_empty() || function.uses_velocities())
        {
            return Err(format!("{what} may depend on nothing but t, but `{}` names particles", function.text()));
        }
        crate::allowed::finite(what, self.value(0.0))
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
