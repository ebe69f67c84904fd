//! JSON text to a tree. Strict JSON only, because other programs refuse the extensions.

use super::{Entry, Node, Value};
use crate::report::Report;
use jsonc_parser::ast::{ObjectPropName, Value as Ast};
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, CommentCollectionStrategy, ParseOptions, parse_to_ast};
use std::collections::HashMap;

const STRICT: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// The tree of a JSON text, or `None` after reporting its errors.
pub(crate) fn parse(text: &str, report: &mut Report<'_>) -> Option<Node> {
    let collect = CollectOptions { comments: CommentCollectionStrategy::Off, tokens: false };
    match parse_to_ast(text, &collect, &STRICT) {
        Ok(parsed) => {
            let node = parsed.value.map(|ast| node_of(ast, report));
            // After a key that is given twice the tree is ambiguous.
            if report.is_empty() { node } else { None }
        }
        Err(error) => {
            let range = error.range();
            report.error(range.start..range.end, format!("not valid JSON: {}", lower(error.kind())), None);
            None
        }
    }
}

fn lower(kind: &impl ToString) -> String {
    let text = kind.to_string();
    let mut letters = text.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

// Recursion is bounded by the parser, which refuses more than 512 levels.
fn node_of(ast: Ast<'_>, report: &mut Report<'_>) -> Node {
    let span = ast.start()..ast.end();
    let value = match ast {
        Ast::StringLit(text) => Value::Text(text.value.into_owned()),
        Ast::NumberLit(number) => Value::Number(number.value.parse().unwrap_or(f64::NAN)),
        Ast::BooleanLit(truth) => Value::Truth(truth.value),
        Ast::NullKeyword(_) => Value::Other("null"),
        Ast::Array(list) => Value::List(list.elements.into_iter().map(|item| node_of(item, report)).collect()),
        Ast::Object(object) => {
            let mut seen: HashMap<String, usize> = HashMap::new();
            let mut entries = Vec::with_capacity(object.properties.len());
            for property in object.properties {
                let key_span = match &property.name {
                    ObjectPropName::String(name) => name.start()..name.end(),
                    ObjectPropName::Word(name) => name.start()..name.end(),
                };
                let key = property.name.into_string();
                if let Some(first) = seen.insert(key.clone(), key_span.start) {
                    let line = report.line_of(first);
                    let message = format!("the key {} is given twice", report.quoted(&key));
                    report.error(
                        key_span.clone(),
                        message,
                        Some(format!("keep one of them; the first is in line {line}")),
                    );
                }
                entries.push(Entry { key, key_span, node: node_of(property.value, report) });
            }
            Value::Table(entries)
        }
    };
    Node { span, value }
}
