//! TOML text to a tree.

use super::{Entry, Node, Value};
use crate::report::Report;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

/// The tree of a TOML text, or `None` after reporting its errors.
pub(crate) fn parse(text: &str, report: &mut Report<'_>) -> Option<Node> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut last_line = 0;
    for error in &errors {
        // The parser gives no place, or the beginning, where tables are nested too deep.
        let span = error.span().filter(|span| *span != (0..0)).unwrap_or_else(|| deepest(text));
        let line = report.line_of(span.start);
        // The parser goes on after an error; later errors in the same line follow from the first.
        if line != last_line {
            report.error(
                span.clone(),
                format!("not valid TOML: {}", in_words(error.message(), text.get(span.start..).unwrap_or_default())),
                None,
            );
            last_line = line;
        }
    }
    // The checks of a repaired tree would report keys that the repair lost.
    errors.is_empty().then(|| Node { span: 0..0, value: table_of(table.get_ref()) })
}

/// The line with the most levels of keys, lists and tables.
fn deepest(text: &str) -> Range<usize> {
    let levels = |line: &str| line.matches(['.', '[', '{']).count();
    let mut start = 0;
    let mut most = (0, 0..0);
    for line in text.split_inclusive('\n') {
        if levels(line) > most.0 {
            most = (levels(line), start..start + line.trim_end().len());
        }
        start += line.len();
    }
    most.1
}

/// The message of the parser in one line. Where a value is missing, the parser names the last kind of value it tried,
/// and this function says that the value is missing.
fn in_words(message: &str, rest: &str) -> String {
    if message.contains("literal string") && rest.trim_start_matches(' ').starts_with(['\n', '\r', '}', ']', ',', '#'])
    {
        return "a value is missing here".to_owned();
    }
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn table_of(table: &DeTable<'_>) -> Value {
    let entries = table.iter().map(|(key, value)| Entry {
        key: key.get_ref().to_string(),
        key_span: key.span(),
        node: Node { span: value.span(), value: value_of(value.get_ref()) },
    });
    Value::Table(entries.collect())
}

// Recursion is bounded by the parser, which refuses more than 80 levels.
fn value_of(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        // 128 bits hold every whole number a person would write; beyond that it is too large, as 1e999 is.
        DeValue::Integer(number) => {
            Value::Number(i128::from_str_radix(number.as_str(), number.radix()).map_or(f64::INFINITY, |n| n as f64))
        }
        DeValue::Float(number) => Value::Number(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(truth) => Value::Truth(*truth),
        DeValue::Datetime(_) => Value::Other("a date"),
        DeValue::Array(items) => {
            Value::List(items.iter().map(|item| Node { span: item.span(), value: value_of(item.get_ref()) }).collect())
        }
        DeValue::Table(table) => table_of(table),
    }
}
