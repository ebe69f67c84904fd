//! `[parameters]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter of the scene: its value, or a table with its value, its range and its unit.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Parameter {
    Number(f64),
    Table(ParameterTable),
}

/// A parameter with its range and its unit.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ParameterTable {
    /// The value of the parameter.
    pub(crate) value: f64,
    /// The least value of the parameter; no limit if left out.
    #[serde(default)]
    pub(crate) min: Option<f64>,
    /// The greatest value of the parameter; no limit if left out.
    #[serde(default)]
    pub(crate) max: Option<f64>,
    /// The unit of the parameter, for people.
    #[serde(default)]
    #[schemars(length(max = 20))]
    pub(crate) unit: String,
}

impl Parameter {
    pub(crate) fn value(&self) -> f64 {
        match self {
            Parameter::Number(value) => *value,
            Parameter::Table(table) => table.value,
        }
    }

    /// The parameter as the engine takes it.
    pub(crate) fn named(&self, name: &str) -> qhat::Parameter {
        let plain = qhat::Parameter::new(name, self.value());
        match self {
            Parameter::Number(_) => plain,
            Parameter::Table(ParameterTable { min, max, unit, .. }) => {
                let range = [min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY)];
                qhat::Parameter { range, unit: unit.clone(), ..plain }
            }
        }
    }
}
