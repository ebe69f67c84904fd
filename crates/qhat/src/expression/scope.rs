//! Scope: which names an expression may use, and what they mean.

use super::error::ParameterError;
use super::functions::FUNCTIONS;
use super::token::is_name;
use crate::space::{Dimension, ParticleId};

/// What an expression is for, which decides what it may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// C(q, t) = 0: positions and time.
    Constraint,
    /// A component of a force: positions, velocities and time.
    Force,
    /// A potential energy: positions and time.
    Potential,
    /// A number that is driven: time alone.
    Time,
    /// A component of a curve: its parameter alone, which is written `s` in the place of `t`.
    Curve,
}

impl Purpose {
    /// How the variable that is no coordinate is written.
    pub(super) fn variable(self) -> &'static str {
        if self == Purpose::Curve { "s" } else { "t" }
    }
}

/// The names that an expression may use beside `t`, `pi` and `tau`.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    /// What the expression is for.
    pub purpose: Purpose,
    /// d.
    pub dimension: Dimension,
    /// The particle of a name.
    pub particle: &'a dyn Fn(&str) -> Option<ParticleId>,
    /// The number of a parameter; its name and number have passed [`check_parameter`].
    pub parameter: &'a dyn Fn(&str) -> Option<f64>,
    /// The name nearest to one that does not exist, among these and those of the scope, for "did you mean".
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
    if FUNCTIONS.iter().any(|function| function.name == name) {
        return Err(ParameterError::Function { name: name_of() });
    }
    if !value.is_finite() {
        return Err(ParameterError::NotFinite { name: name_of(), value });
    }
    Ok(())
}

/// Numbers with a name of their own.
pub(super) const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU)];
