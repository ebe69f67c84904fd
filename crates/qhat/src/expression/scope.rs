//! Scope: the names that an expression may use, and their meaning.

use super::functions::FUNCTIONS;
use super::token::is_name;
use crate::space::{Dimension, ParticleId};

/// The purpose of an expression, which decides what the expression may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// C(q, t) = 0: positions and time.
    Constraint,
    /// A component of a force: positions, velocities and time.
    Force,
    /// A potential energy: positions and time.
    Potential,
    /// A driven number: time alone.
    Time,
    /// A component of a curve: the parameter of the curve alone, written `s` in the place of `t`.
    Curve,
}

impl Purpose {
    /// The letter of the variable that is no coordinate.
    pub(super) fn variable(self) -> &'static str {
        if self == Purpose::Curve { "s" } else { "t" }
    }
}

/// The names that an expression may use beside `t`, `pi` and `tau`.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    /// The purpose of the expression.
    pub purpose: Purpose,
    /// The number of dimensions.
    pub dimension: Dimension,
    /// The particle of a name.
    pub particle: &'a dyn Fn(&str) -> Option<ParticleId>,
    /// The value of a parameter; its name and value have passed [`check_parameter`].
    pub parameter: &'a dyn Fn(&str) -> Option<f64>,
    /// The known name nearest to one that does not exist, for "did you mean".
    pub suggest: &'a dyn Fn(&str, &[&'static str]) -> Option<String>,
}

impl<'a> Scope<'a> {
    /// A scope without parameters that suggests nothing.
    pub fn new(purpose: Purpose, dimension: Dimension, particle: &'a dyn Fn(&str) -> Option<ParticleId>) -> Self {
        Scope { purpose, dimension, particle, parameter: &|_| None, suggest: &|_, _| None }
    }
}

/// `Ok` if a parameter may have this name and this value.
pub fn check_parameter(name: &str, value: f64) -> Result<(), String> {
    if !is_name(name) {
        return Err(format!(
            "`{name}` is not a name: a name begins with a letter or `_` and goes on with letters, digits or `_`"
        ));
    }
    if CONSTANTS.iter().any(|(constant, _)| *constant == name) || name == "t" {
        return Err(format!("`{name}` already has a meaning in expressions: give the parameter another name"));
    }
    if FUNCTIONS.iter().any(|function| function.name == name) {
        return Err(format!("`{name}` is a function: give the parameter another name"));
    }
    if !value.is_finite() {
        return Err(format!("the parameter `{name}` must be a finite number, but is {value}"));
    }
    Ok(())
}

/// The named numbers of the language.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU)];
