//! What is written as expressions: `kind = "expression"` of `[[constraints]]`, `kind = "force"` and `"potential"` of `[[loads]]`.

use super::{Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Numbers that expressions refer to by name.
pub(crate) type Parameters = BTreeMap<String, f64>;

/// Expressions of positions and time that stay zero.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpressionConstraint {
    /// Its name in reports; `expression`, with a number behind it where that is taken, if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The expression that stays zero, or a list of them.
    pub(crate) residual: Residual,
    /// A table of numbers that the expression refers to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
    /// The size of the residual that counts as a relative error of 1, in its own unit, above 0; measured at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) scale: Option<f64>,
}

/// One expression or several.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Residual {
    One(String),
    Several(#[schemars(length(min = 1, max = 1000))] Vec<String>),
}

/// A force on one particle, written as expressions of positions, velocities and time.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpressionForce {
    /// The id of the particle it acts on.
    pub(crate) particle: Id,
    /// An expression for each component of the force [N].
    #[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))]
    pub(crate) force: Vec<String>,
    /// A table of numbers that the expressions refer to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
}

/// A potential energy, written as an expression of positions and time, that pulls every particle in it downhill.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ExpressionPotential {
    /// The expression of the energy [J].
    pub(crate) potential: String,
    /// A table of numbers that the expression refers to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
}
