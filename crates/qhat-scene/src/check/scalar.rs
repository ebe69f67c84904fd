//! Numbers: finite, whole where they count things, in range.

use super::Checker;
use super::meaning::Meaning;
use crate::tree::Node;
use serde_json::Value as Json;

impl<'a> Checker<'a, '_, '_> {
    pub(super) fn number(&mut self, node: &Node, number: f64, meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let written = self.report.written(&node.span);
        let complaint = if number.is_nan() || written.trim_start_matches(['+', '-']) == "inf" {
            format!("`{name}` must be a finite number, but is {written}")
        } else if number.is_infinite() {
            format!("`{name}` is too large a number: {written}")
        } else if meaning.text("type") == "integer" && number.fract() != 0.0 {
            format!("`{name}` must be a whole number, but is {written}")
        } else if let Some(range) = outside(number, meaning) {
            format!("`{name}` must be {range}, but is {written}")
        } else {
            return Some(json(number, meaning));
        };
        self.report.error(node.span.clone(), complaint, Some(meaning.help(name)));
        None
    }
}

/// The range that a number is not in, in words.
fn outside(number: f64, meaning: Meaning<'_>) -> Option<String> {
    let least = meaning.number("minimum");
    let above = meaning.number("exclusiveMinimum");
    let most = meaning.number("maximum");
    let below = meaning.number("exclusiveMaximum");
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

/// Whole numbers stay whole, so that serde can fill integers; −0 stays what it is.
fn json(number: f64, meaning: Meaning<'_>) -> Json {
    match meaning.text("type") {
        "integer" if number < 0.0 => Json::from(number as i64),
        "integer" => Json::from(number as u64),
        _ => Json::from(number),
    }
}
