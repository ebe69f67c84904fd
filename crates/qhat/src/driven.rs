//! A number that may change with time: the length of a driven rod, the angle of a crank.

use crate::allowed::{ValueError, finite};
use crate::expression::Expression;
use crate::number::Number;

/// A number, or a function of t alone.
#[derive(Clone, Debug, PartialEq)]
pub enum Driven {
    /// It stays.
    Constant(f64),
    /// It follows an expression that depends on nothing but t [s].
    Function(Expression),
}

impl Driven {
    /// s and ṡ at t. With a derivative in t they carry theirs: ṡ and s̈.
    pub(crate) fn at<N: Number>(&self, t: N) -> (N, N) {
        match self {
            Driven::Constant(value) => (N::constant(*value), N::constant(0.0)),
            Driven::Function(function) => {
                let jet = function.jet(&[], &[], t.value());
                (t.with(jet.value, jet.first), t.with(jet.first, jet.second))
            }
        }
    }

    /// Its value at t [s].
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
