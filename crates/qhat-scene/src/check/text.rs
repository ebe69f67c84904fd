//! Texts: their length, their pattern, and texts out of a list.

use super::{Checker, SchemaNode};
use crate::model::PATTERNS;
use crate::suggest::{listed, nearest};
use crate::tree::{Node, Value};
use serde_json::Value as Json;

impl<'a> Checker<'a, '_, '_> {
    pub(super) fn text(&mut self, node: &Node, text: &str, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let length = text.chars().count() as u64;
        let (least, most) = (schema.whole("minLength").unwrap_or(0), schema.whole("maxLength").unwrap_or(u64::MAX));
        if !(least..=most).contains(&length) {
            let message = format!("`{name}` must have {least} to {most} characters, but has {length}");
            self.report.error(node.span.clone(), message, Some(schema.help(name)));
            return None;
        }
        let pattern = PATTERNS.iter().find(|pattern| pattern.regex == schema.text("pattern"));
        if let Some(pattern) = pattern.filter(|pattern| !(pattern.agrees)(text)) {
            let message = format!("{} cannot be `{name}`", self.report.quoted(text));
            self.report.error(node.span.clone(), message, Some(format!("use {}", pattern.words)));
            return None;
        }
        Some(Json::String(text.to_owned()))
    }

    pub(super) fn choice(&mut self, node: &Node, name: &str, choices: &[&str]) -> Option<Json> {
        let Value::Text(given) = &node.value else {
            let message = format!("`{name}` must be text, but is {}", self.found(node));
            self.report.error(node.span.clone(), message, Some(format!("use {}", listed(choices))));
            return None;
        };
        if choices.contains(&given.as_str()) {
            return Some(Json::String(given.clone()));
        }
        self.unknown_choice(node, given, name, choices);
        None
    }

    pub(super) fn unknown_choice(&mut self, node: &Node, given: &str, name: &str, choices: &[&str]) {
        let quoted = self.report.quoted(given);
        let list = listed(choices);
        let help = match nearest(given, choices.iter().copied()) {
            Some(choice) if choices.len() > 1 => format!("did you mean `{choice}`? `{name}` is {list}"),
            _ => format!("use {list}"),
        };
        self.report.error(node.span.clone(), format!("unknown {name} {quoted}"), Some(help));
    }
}
