//! Checks a tree against the schema: keys, types and ranges. Reports all errors at once, each with its place in the
//! text.

mod misplaced;
mod number;
mod schema_node;
mod table;
mod text;

use crate::parameters::{Parameters, Use};
use crate::report::Report;
use crate::tree::{Node, Value};
use schema_node::SchemaNode;
use serde_json::Value as Json;

/// The part of a tree that agrees with the schema.
pub(crate) struct Checked {
    /// The tree without the keys that do not agree.
    pub(crate) value: Json,
    /// Whether a table or list is left out. Errors about references to it would mislead.
    pub(crate) has_gaps: bool,
    /// The numbers that texts of parameters give.
    pub(crate) uses: Vec<Use>,
}

/// Checks a tree against the schema; `None` when a required key of the scene is missing or wrong.
pub(crate) fn check(
    tree: &Node,
    schema: &Json,
    parameters: &Parameters<'_>,
    report: &mut Report<'_>,
) -> Option<Checked> {
    let dimension = match tree.get("dimension").map(|node| &node.value) {
        Some(Value::Number(number)) if *number == 2.0 => Some(2),
        Some(Value::Number(number)) if *number == 3.0 => Some(3),
        _ => None,
    };
    let mut checker = Checker { root: schema, dimension, parameters, report, has_gaps: false, uses: Vec::new() };
    let value = checker.value(tree, SchemaNode::of(schema, schema), "the scene")?;
    Some(Checked { value, has_gaps: checker.has_gaps, uses: checker.uses })
}

struct Checker<'a, 'r, 't> {
    root: &'a Json,
    dimension: Option<usize>,
    parameters: &'r Parameters<'r>,
    report: &'r mut Report<'t>,
    has_gaps: bool,
    uses: Vec<Use>,
}

impl<'a> Checker<'a, '_, '_> {
    /// The part of a value that agrees. Messages call the value `name`: a key, or a phrase with spaces.
    fn value(&mut self, node: &Node, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        if schema.is_tagged() {
            return self.tagged(node, schema, name);
        }
        if let Some(choices) = schema.choices() {
            return self.choice(node, name, &choices);
        }
        if let Some(alternative) =
            schema.alternatives(self.root).find(|alternative| agrees(alternative.text("type"), node))
        {
            return self.value(node, alternative, name);
        }
        if schema.is_number_or_text() {
            return match &node.value {
                Value::Number(number) => self.number(node, *number, schema, name),
                // A text that names nothing but parameters is a number.
                Value::Text(text) => match self.parameters.expression(text) {
                    Ok(expression) if !expression.is_constant() => self.value_of(node, expression, schema, name),
                    _ => self.text(node, text, schema, name),
                },
                _ => self.mismatch(node, schema, name),
            };
        }
        match (schema.text("type"), &node.value) {
            ("object", Value::Table(entries)) if schema.names(self.root).is_some() => self.map(entries, schema, name),
            ("object", Value::Table(entries)) => self.table(node, entries, schema, name),
            ("array", Value::List(items)) => self.list(node, items, schema, name),
            ("string", Value::Text(text)) => self.text(node, text, schema, name),
            ("number" | "integer", Value::Number(number)) => self.number(node, *number, schema, name),
            ("number" | "integer", Value::Text(text)) => self.computed(node, text, schema, name),
            ("boolean", Value::Truth(truth)) => Some(Json::Bool(*truth)),
            _ => self.mismatch(node, schema, name),
        }
    }

    fn list(&mut self, node: &Node, items: &[Node], schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let Some(inner) = schema.entry(self.root) else { return self.mismatch(node, schema, name) };
        let (least, most) = match self.dimension.filter(|_| schema.is_vector()) {
            Some(dimension) => (dimension as u64, dimension as u64),
            None => (schema.whole("minItems").unwrap_or(0), schema.whole("maxItems").unwrap_or(u64::MAX)),
        };
        if !(least..=most).contains(&(items.len() as u64)) {
            let wanted = match most {
                u64::MAX => format!("at least {least}"),
                most if least == most => format!("{least}"),
                most => format!("{least} to {most}"),
            };
            let message = format!("`{name}` must have {wanted} entries, but has {}", items.len());
            self.report.error(node.span.clone(), message, Some(self.help(schema, name)));
            return None;
        }
        let is_list_of_tables = inner.is_tagged() || inner.properties().is_some();
        let mut list = Vec::new();
        let mut complete = true;
        for (index, item) in items.iter().enumerate() {
            if self.report.is_full() {
                return self.gap();
            }
            let item_name =
                if is_list_of_tables { format!("this entry of `{name}`") } else { format!("{name}[{index}]") };
            match self.value(item, inner, &item_name) {
                Some(value) => list.push(value),
                None => complete = false,
            }
        }
        match (complete, is_list_of_tables) {
            (true, _) => Some(Json::Array(list)),
            (false, true) => self.gap(),
            (false, false) => None,
        }
    }

    /// Reports a value of another type than the schema asks for.
    fn mismatch(&mut self, node: &Node, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let message = format!("{} must be {}, but is {}", called(name), schema.type_in_words(), self.found(node));
        let help = (!name.contains(' ')).then(|| self.help(schema, name));
        self.report.error(node.span.clone(), message, help);
        if schema.is_tagged() || matches!(schema.text("type"), "object" | "array") { self.gap() } else { None }
    }

    /// The help for a key: its description, with the number of entries that the dimension asks for.
    fn help(&self, schema: SchemaNode<'a>, name: &str) -> String {
        let dimension = self.dimension.filter(|_| schema.is_vector());
        let entries = if schema.entry(self.root).is_some_and(|entry| entry.text("type") == "string") {
            "texts"
        } else {
            "numbers"
        };
        let numbers = dimension.map(|d| format!("; {d} {entries}, as the dimension is {d}"));
        format!("{}{}", schema.help(name), numbers.unwrap_or_default())
    }

    /// The value in the scene, in words.
    fn found(&self, node: &Node) -> String {
        match &node.value {
            Value::Text(text) => format!("the text {}", self.report.quoted(text)),
            Value::Number(_) => format!("the number {}", self.report.written(&node.span)),
            Value::Truth(truth) => truth.to_string(),
            Value::List(_) => "a list".to_owned(),
            Value::Table(_) => "a table".to_owned(),
            Value::Other(what) => (*what).to_owned(),
        }
    }

    /// Notes that a table or list is left out.
    fn gap<T>(&mut self) -> Option<T> {
        self.has_gaps = true;
        None
    }
}

/// Whether a value is of a type of the schema.
fn agrees(kind: &str, node: &Node) -> bool {
    matches!(
        (kind, &node.value),
        ("string", Value::Text(_))
            | ("array", Value::List(_))
            | ("number", Value::Number(_))
            | ("object", Value::Table(_))
    )
}

/// A key in backticks; a phrase unchanged.
fn called(name: &str) -> String {
    if name.contains(' ') { name.to_owned() } else { format!("`{name}`") }
}
