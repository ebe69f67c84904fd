//! Tables that hold expressions: `kind = "expression"` of `[[constraints]]`, `kind = "force"` and `"potential"` of
//! `[[loads]]`.

use super::constraint::named;
use super::{Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Numbers that expressions refer to by name.
pub(crate) type Parameters = BTreeMap<String, f64>;

/// Expressions of positions and time that stay zero.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Expression {
    /// The name of the constraint in reports; `expression` if left out, with a number behind it where that name is
    /// taken.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The expression that stays zero, or a list of them.
    pub(crate) residual: Residual,
    /// A table of numbers that the expression refers to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
    /// The size of the residual that counts as a relative error of 1, in the unit of the residual, above 0; measured at
    /// the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) scale: Option<f64>,
}

named!(Expression, _it => "expression".to_owned());

/// One expression or several.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Residual {
    One(String),
    Several(#[schemars(length(min = 1, max = 1000))] Vec<String>),
}

/// A force on one particle, as expressions of positions, velocities and time.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Force {
    /// The id of the particle that the force acts on.
    pub(crate) particle: Id,
    /// An expression for each component of the force [N].
    #[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))]
    pub(crate) force: Vec<String>,
    /// A table of numbers that the expressions refer to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
}

/// A potential energy, as an expression of positions and time. Every particle in the expression feels the force −∂V/∂q.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Potential {
    /// The expression of the energy [J].
    pub(crate) potential: String,
    /// A table of numbers that the expression refers to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
}
