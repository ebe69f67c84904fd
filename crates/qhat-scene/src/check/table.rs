//! Tables: their kind, unknown keys, missing keys, and the value of each key.

use super::{Checker, SchemaNode, called, misplaced};
use crate::suggest::{listed, nearest};
use crate::tree::{Entry, Node, Value};
use serde_json::Value as Json;

impl<'a> Checker<'a, '_, '_> {
    /// A table whose `kind` determines its keys.
    pub(super) fn tagged(&mut self, node: &Node, schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let Value::Table(entries) = &node.value else { return self.mismatch(node, schema, name) };
        let kinds: Vec<&str> = schema.kinds().map(|(kind, _)| kind).collect();
        let Some(tag) = node.get("kind") else {
            let help = format!("add `kind`, {}", listed(&kinds));
            self.report.error(node.span.clone(), format!("`kind` is missing in {}", called(name)), Some(help));
            return self.gap();
        };
        let Value::Text(given) = &tag.value else {
            let message = format!("`kind` must be text, but is {}", self.found(tag));
            self.report.error(tag.span.clone(), message, Some(format!("use {}", listed(&kinds))));
            return self.gap();
        };
        match schema.kinds().find(|(kind, _)| kind == given) {
            Some((_, branch)) => self.table(node, entries, SchemaNode::of(self.root, branch), name),
            None => {
                self.unknown_choice(tag, given, "kind", &kinds);
                self.gap()
            }
        }
    }

    pub(super) fn table(&mut self, node: &Node, entries: &[Entry], schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let Some(properties) = schema.properties() else { return self.mismatch(node, schema, name) };
        self.refuse_unknown_keys(entries, schema, name);

        let required: Vec<&str> = schema.required().collect();
        let missing: Vec<&str> = required.iter().copied().filter(|key| node.get(key).is_none()).collect();
        if !missing.is_empty() {
            let verb = if missing.len() == 1 { "is" } else { "are" };
            let message = format!("{} {verb} missing in {}", quoted_list(&missing), called(name));
            let helps =
                missing.iter().filter_map(|key| Some(SchemaNode::of(self.root, properties.get(*key)?).help(key)));
            let help = helps.collect::<Vec<_>>().join("\n      ");
            self.report.error(node.span.clone(), message, Some(help));
        }

        let mut table = serde_json::Map::new();
        let mut complete = missing.is_empty();
        for (key, schema) in properties {
            let Some(child) = node.get(key) else { continue };
            match self.value(child, SchemaNode::of(self.root, schema), key) {
                Some(value) => {
                    table.insert(key.clone(), value);
                }
                None => complete &= !required.contains(&key.as_str()),
            }
        }
        if complete { Some(Json::Object(table)) } else { self.gap() }
    }

    fn refuse_unknown_keys(&mut self, entries: &[Entry], schema: SchemaNode<'a>, name: &str) {
        let Some(properties) = schema.properties() else { return };
        let mut keys: Vec<&str> = properties.keys().map(String::as_str).collect();
        keys.sort_unstable();
        let is_root = schema.is(self.root);
        for entry in entries {
            if properties.contains_key(&entry.key) || self.report.is_full() {
                continue;
            }
            // Under a misspelt key for the list of particles every id would be unknown.
            if is_root {
                self.has_gaps = true;
            }
            let elsewhere = if is_root { misplaced::help(self.root, &entry.key) } else { None };
            let help = elsewhere.unwrap_or_else(|| match nearest(&entry.key, keys.iter().copied()) {
                Some(key) => format!("did you mean `{key}`?"),
                None => format!("the keys here are {}", quoted_list(&keys)),
            });
            let message = format!("unknown key {} in {}", self.report.quoted(&entry.key), called(name));
            self.report.error(entry.key_span.clone(), message, Some(help));
        }
    }

    /// A table whose keys are names that the scene gives.
    pub(super) fn map(&mut self, entries: &[Entry], schema: SchemaNode<'a>, name: &str) -> Option<Json> {
        let inner = schema.names(self.root)?;
        let mut map = serde_json::Map::new();
        for entry in entries {
            let entry_name = format!("{name}[{}]", self.report.fitted(&entry.key));
            if let Some(value) = self.value(&entry.node, inner, &entry_name) {
                map.insert(entry.key.clone(), value);
            }
        }
        if map.len() == entries.len() { Some(Json::Object(map)) } else { self.gap() }
    }
}

fn quoted_list(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    quoted.join(", ")
}
