//! Numbers: finite, whole where the schema asks for a whole number, in range.

use super::{Checker, SchemaNode};
use crate::parameters::Use;
use crate::tree::Node;
use qhat::Expression;
use serde_json::Value as Json;

impl<'a> Checker<'a, '_, '_> {
    pub(super) fn number(&mut self, node: &Node, number: f64, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let written = self.report.written(&node.span);
        self.in_range(node, number, written, schema, name)
    }

    /// A number that a text of parameters gives.
    pub(super) fn computed(&mut self, node: &Node, text: &str, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        // Parameters of parameters could go in circles, and vectors are checked with the dimension as it is written.
        if self.parameters.has(&node.span) || name == "dimension" {
            return self.mismatch(node, schema, name);
        }
        if text.trim().parse::<f64>().is_ok() {
            let message = format!("`{name}` is a text, {}, but must be a number", self.report.written(&node.span));
            self.report.error(node.span.clone(), message, Some("write the number without quotation marks".into()));
            return None;
        }
        match self.parameters.expression(text) {
            Ok(expression) => self.value_of(node, expression, schema, name),
            Err(_) if has_unit(text) => self.mismatch(node, schema, name),
            Err(error) => {
                let kind = schema.type_in_words();
                let message = format!(
                    "{} must be {kind} or an expression of parameters, but is the text {}: {}",
                    super::called(name),
                    self.report.quoted(text),
                    self.report.fitted(&error.message)
                );
                let help = error.help.map(|help| self.report.fitted(&help));
                let help = help.or_else(|| (!name.contains(' ')).then(|| self.help(schema, name)));
                self.report.error(self.report.piece(&node.span, text, &error.span), message, help);
                None
            }
        }
    }

    /// The value of an expression of parameters, whose use is noted.
    pub(super) fn value_of(
        &mut self,
        node: &Node,
        expression: Expression,
        schema: SchemaNode<'a>,
        name: &str,
    ) -> Option<Json> {
        let number = self.parameters.value(&expression);
        let written = format!("{number:?}, the value of `{}`", self.report.fitted(expression.text()));
        let checked = self.in_range(node, number, written, schema, name)?;
        if !expression.is_constant() {
            self.uses.push(Use { expression, place: node.span.clone() });
        }
        Some(checked)
    }

    /// A number as JSON, if it is finite, whole where it must be, and in range. Messages say that it is `written`.
    fn in_range(
        &mut self,
        node: &Node,
        number: f64,
        written: String,
        schema: SchemaNode<'a>,
        name: &str,
    ) -> Option<Json> {
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

/// Whether a text is a number with a unit, such as `1 kg`.
fn has_unit(text: &str) -> bool {
    let text = text.trim();
    let (number, unit) =
        text.split_at(text.find(|letter: char| !"+-.0123456789 ".contains(letter)).unwrap_or(text.len()));
    let is_unit = unit.starts_with(char::is_alphabetic) && !unit.contains(['(', '+', '-']);
    number.trim().parse::<f64>().is_ok() && is_unit
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
