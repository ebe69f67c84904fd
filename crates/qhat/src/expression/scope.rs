//! Scope: the names that an expression may use, and their meaning.

use super::error::ParameterError;
use super::functions::function;
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
    /// A number of a system: parameters alone, which are the inputs of the expression.
    Parameters,
}

impl Purpose {
    /// The letter of the variable that is no coordinate; empty where there is none.
    pub(super) fn variable(self) -> &'static str {
        match self {
            Purpose::Curve => "s",
            Purpose::Parameters => "",
            _ => "t",
        }
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

/// `Ok` if a parameter can have this name and this number.
///
/// # Errors
/// A name that is no word, or that has a meaning already; a number that is not finite.
pub fn check_parameter(name: &str, value: f64) -> Result<(), ParameterError> {
    let name_of = || name.to_owned();
    if !is_name(name) {
        return Err(ParameterError::NotAName { name: name_of() });
    }
    if CONSTANTS.iter().any(|(constant, _)| *constant == name) || name == "t" {
        return Err(ParameterError::NameTaken { name: name_of() });
    }
    if function(name).is_some() {
        return Err(ParameterError::Function { name: name_of() });
    }
    if !value.is_finite() {
        return Err(ParameterError::NotFinite { name: name_of(), value });
    }
    Ok(())
}

/// The named numbers of the language.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU)];
