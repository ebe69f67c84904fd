//! Numbers: finite, whole where the schema asks for a whole number, in range.

use super::{Checker, SchemaNode};
use crate::tree::Node;
use serde_json::Value as Json;

impl<'a> Checker<'a, '_, '_> {
    pub(super) fn number(&mut self, node: &Node, number: f64, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let written = self.report.written(&node.span);
        let complaint = if number.is_nan() || written.trim_start_matches(['+', '-']) == "inf" {
            format!("`{name}` must be a finite number, but is {written}")
        } else if number.is_infinite() {
            format!("`{name}` is too large a number: {written}")
        } else if schema.text("type") == "integer" && number.fract() != 0.0 {
            format!("`{name}` must be a whole number, but is {written}")
        } else if let Some(range) = outside(number, schema) {
            format!("`{name}` must be {range}, but is {written}")
        } else {
            return Some(json(number, schema));
        };
        let help = if name == "length" && number == 0.0 {
            format!(
                "{}; two particles that stay at one place are a constraint of kind `coincidence`",
                schema.help(name)
            )
        } else {
            schema.help(name)
        };
        self.report.error(node.span.clone(), complaint, Some(help));
        None
    }
}

/// The allowed range in words, where a number is outside of it.
fn outside(number: f64, schema: SchemaNode<'_>) -> Option<String> {
    let least = schema.number("minimum");
    let above = schema.number("exclusiveMinimum");
    let most = schema.number("maximum");
    let below = schema.number("exclusiveMaximum");
    let inside = least.is_none_or(|least| number >= least)
        && above.is_none_or(|above| number > above)
        && most.is_none_or(|most| number <= most)
        && below.is_none_or(|below| number < below);
    if inside {
        return None;
    }
    let lower = least.map(|least| format!("at least {least:?}")).or(above.map(|above| format!("above {above:?}")));
    let upper = most.map(|most| format!("at most {most:?}")).or(below.map(|below| format!("below {below:?}")));
    let ends = [lower, upper].into_iter().flatten().collect::<Vec<_>>();
    Some(ends.join(" and ").replace(".0 ", " ").trim_end_matches(".0").to_owned())
}

/// A number as JSON. Whole numbers stay whole, so that serde can fill integers; −0 stays −0.
fn json(number: f64, schema: SchemaNode<'_>) -> Json {
    match schema.text("type") {
        "integer" if number < 0.0 => Json::from(number as i64),
        "integer" => Json::from(number as u64),
        _ => Json::from(number),
    }
}
