//! Driven numbers: a number, or an expression of t as text.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A number, or an expression of t.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Driven {
    Number(f64),
    Text(String),
}

impl JsonSchema for Driven {
    fn schema_name() -> Cow<'static, str> {
        "Driven".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"] })
    }
}

/// One driven number for each dimension.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct DrivenVector(
    #[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))] pub(crate) Vec<Driven>,
);
