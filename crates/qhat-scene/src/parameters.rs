//! `[parameters]`: the named numbers of a scene, read before anything else, because any number of the scene may be a
//! text that names them.

use crate::report::Report;
use crate::suggest::{listed, nearest};
use crate::tree::{Entry, Node, Step, Value};
use qhat::{Expression, ExpressionError, Parameter};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The parameters of a scene by name, in the order of the text. Those that have no number are left out; `check` refuses
/// them.
#[derive(Debug, Default)]
pub(crate) struct Parameters<'a> {
    names: Vec<&'a str>,
    values: Vec<f64>,
    /// The places where texts below `[parameters]` begin.
    texts: HashSet<usize>,
}

/// A number of the scene that is given by a text, and the place of that text.
#[derive(Debug)]
pub(crate) struct Use {
    pub(crate) expression: Expression,
    pub(crate) place: Range<usize>,
}

impl<'a> Parameters<'a> {
    pub(crate) fn of(tree: &'a Node) -> Self {
        let mut parameters = Parameters::default();
        let Some(table) = tree.get("parameters") else { return parameters };
        parameters.texts = ways(table).into_keys().collect();
        for Entry { key, node, .. } in table.entries() {
            if let Value::Number(value) = node.key("value").value {
                parameters.names.push(key);
                parameters.values.push(value);
            }
        }
        parameters
    }

    /// Whether a text lies in the table of the parameters. In TOML such a table need not be one piece of the scene.
    pub(crate) fn has(&self, text: &Range<usize>) -> bool {
        self.texts.contains(&text.start)
    }

    /// The expression of a text that names parameters.
    ///
    /// # Errors
    /// As [`Expression::parse`].
    pub(crate) fn expression(&self, text: &str) -> Result<Expression, ExpressionError> {
        let suggest = |name: &str, own: &[&'static str]| {
            nearest(name, self.names.iter().copied().chain(own.iter().copied())).map(str::to_owned)
        };
        Expression::of_parameters(text, &self.names, &suggest)
    }

    /// The value of such an expression.
    pub(crate) fn value(&self, expression: &Expression) -> f64 {
        expression.value(&self.values, &[], 0.0)
    }
}

/// Puts values that are given from outside in the place of those of the text; reports those that the scene does not
/// take.
pub(crate) fn set(tree: &mut Node, given: &[(String, f64)], report: &mut Report<'_>) {
    for (name, value) in given {
        let place = tree.key("parameters").span.clone();
        let Some(table) = tree.get_mut("parameters") else {
            let message = format!("there is no parameter {} to set: the scene has none", report.quoted(name));
            let help = "write `[parameters]` with a number for each name, and the names where numbers stand";
            report.error(0..0, message, Some(help.into()));
            continue;
        };
        let names: Vec<&str> = table.entries().iter().map(|entry| entry.key.as_str()).collect();
        let help = match nearest(name, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the parameters of this scene are {}", listed(&names)),
        };
        let Some(entry) = table.get_mut(name) else {
            let message = format!("there is no parameter {} to set", report.quoted(name));
            report.error(place, message, Some(help));
            continue;
        };
        if let Err(reason) = parameter(name, entry).check(*value) {
            report.error(entry.span.clone(), reason.to_string(), Some("set another value, or change the range".into()));
            continue;
        }
        let number = if matches!(entry.value, Value::Table(_)) { entry.get_mut("value") } else { Some(entry) };
        if let Some(number) = number {
            number.value = Value::Number(*value);
        }
    }
}

/// The parameter that a node of `[parameters]` describes.
fn parameter(name: &str, node: &Node) -> Parameter {
    let number = |key: &str, otherwise: f64| match node.get(key).map(|node| &node.value) {
        Some(Value::Number(number)) => *number,
        _ => otherwise,
    };
    let range = [number("min", f64::NEG_INFINITY), number("max", f64::INFINITY)];
    Parameter { range, ..Parameter::new(name, 0.0) }
}

/// The ways to all texts of a tree by the place where each begins.
pub(crate) fn ways(tree: &Node) -> HashMap<usize, Vec<Step<'_>>> {
    let mut ways = HashMap::new();
    let mut open = vec![(tree, Vec::new())];
    while let Some((node, way)) = open.pop() {
        let below = |step| way.iter().cloned().chain([step]).collect::<Vec<_>>();
        match &node.value {
            Value::Table(entries) => open.extend(entries.iter().map(|it| (&it.node, below(Step::Key(&it.key))))),
            Value::List(items) => open.extend(items.iter().enumerate().map(|(k, it)| (it, below(Step::Place(k))))),
            Value::Text(_) => drop(ways.insert(node.span.start, way)),
            _ => {}
        }
    }
    ways
}
