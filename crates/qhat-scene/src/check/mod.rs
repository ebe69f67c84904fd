//! Holds a tree against the schema: keys, types and ranges, all errors at once, each with its place in the text.

mod meaning;
mod scalar;

use crate::model::PATTERNS;
use crate::report::Report;
use crate::suggest::{listed, nearest};
use crate::tree::{Entry, Node, Value};
use meaning::Meaning;
use serde_json::Value as Json;

/// What of a tree agrees with the schema.
pub(crate) struct Checked {
    /// The tree without the keys that do not agree.
    pub(crate) value: Json,
    /// Whether a table or list had to be left out: what refers to it cannot be judged any more.
    pub(crate) has_gaps: bool,
}

/// Holds a tree against the schema; `None` when the scene as a whole does not agree.
pub(crate) fn check(tree: &Node, schema: &Json, report: &mut Report<'_>) -> Option<Checked> {
    let dimension = match tree.get("dimension").map(|node| &node.value) {
        Some(Value::Number(number)) if *number == 2.0 => Some(2),
        Some(Value::Number(number)) if *number == 3.0 => Some(3),
        _ => None,
    };
    let mut checker = Checker { root: schema, dimension, report, has_gaps: false };
    let value = checker.value(tree, Meaning::of(schema, schema), "the scene")?;
    Some(Checked { value, has_gaps: checker.has_gaps })
}

struct Checker<'a, 'r, 't> {
    root: &'a Json,
    dimension: Option<usize>,
    report: &'r mut Report<'t>,
    has_gaps: bool,
}

impl<'a> Checker<'a, '_, '_> {
    /// The value as far as it agrees. `name` is what messages call it.
    fn value(&mut self, node: &Node, meaning: Meaning<'a>, name: &str) -> Option<Json> {
        if meaning.is_tagged() {
            return self.tagged(node, meaning, name);
        }
        if let Some(choices) = meaning.choices() {
            return self.choice(node, meaning, name, &choices);
        }
        match (meaning.text("type"), &node.value) {
            ("object", Value::Table(entries)) => self.table(node, entries, meaning, name),
            ("array", Value::List(items)) => self.list(node, items, meaning, name),
            ("string", Value::Text(text)) => self.text(node, text, meaning, name),
            ("number" | "integer", Value::Number(number)) => self.number(node, *number, meaning, name),
            ("", Value::Number(number)) if meaning.is_driven() => self.number(node, *number, meaning, name),
            ("", Value::Text(text)) if meaning.is_driven() => self.text(node, text, meaning, name),
            ("boolean", Value::Truth(truth)) => Some(Json::Bool(*truth)),
            _ => self.mismatch(node, meaning, name),
        }
    }

    /// A table whose `kind` says which keys it has.
    fn tagged(&mut self, node: &Node, meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let Value::Table(entries) = &node.value else { return self.mismatch(node, meaning, name) };
        let kinds: Vec<&str> = meaning.kinds().map(|(kind, _)| kind).collect();
        let Some(tag) = node.get("kind") else {
            let help = format!("add `kind`, {}", listed(&kinds));
            self.report.error(node.span.clone(), format!("`kind` is missing in {}", called(name)), Some(help));
            return self.gap();
        };
        let given = match &tag.value {
            Value::Text(given) => given,
            _ => {
                let message = format!("`kind` must be text, but is {}", self.found(tag));
                self.report.error(tag.span.clone(), message, Some(format!("use {}", listed(&kinds))));
                return self.gap();
            }
        };
        match meaning.kinds().find(|(kind, _)| kind == given) {
            Some((_, branch)) => self.table(node, entries, Meaning::of(self.root, branch), name),
            None => {
                self.unknown_choice(tag, given, meaning, "kind", &kinds);
                self.gap()
            }
        }
    }

    fn table(&mut self, node: &Node, entries: &[Entry], meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let Some(properties) = meaning.properties() else { return self.mismatch(node, meaning, name) };
        let mut keys: Vec<&str> = properties.keys().map(String::as_str).collect();
        keys.sort_unstable();
        let is_root = std::ptr::eq(meaning.schema, self.root);
        for entry in entries {
            if properties.contains_key(&entry.key) || self.report.is_full() {
                continue;
            }
            // A misspelt list of particles would make every id unknown.
            self.has_gaps |= is_root;
            let help = match nearest(&entry.key, keys.iter().copied()) {
                Some(key) => format!("did you mean `{key}`?"),
                None => format!("the keys here are {}", quoted_list(&keys)),
            };
            let message = format!("unknown key {} in {}", self.report.quoted(&entry.key), called(name));
            self.report.error(entry.key_span.clone(), message, Some(help));
        }

        let required: Vec<&str> = meaning.required().collect();
        let missing: Vec<&str> = required.iter().copied().filter(|key| node.get(key).is_none()).collect();
        if !missing.is_empty() {
            let verb = if missing.len() == 1 { "is" } else { "are" };
            let message = format!("{} {verb} missing in {}", quoted_list(&missing), called(name));
            let helps = missing.iter().filter_map(|key| Some(Meaning::of(self.root, properties.get(*key)?).help(key)));
            let help = helps.collect::<Vec<_>>().join("\n      ");
            self.report.error(node.span.clone(), message, Some(help));
        }

        let mut table = serde_json::Map::new();
        let mut complete = missing.is_empty();
        for (key, schema) in properties {
            let Some(child) = node.get(key) else { continue };
            match self.value(child, Meaning::of(self.root, schema), key) {
                Some(value) => {
                    table.insert(key.clone(), value);
                }
                None => complete &= !required.contains(&key.as_str()),
            }
        }
        if complete { Some(Json::Object(table)) } else { self.gap() }
    }

    fn list(&mut self, node: &Node, items: &[Node], meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let Some(inner) = meaning.entry(self.root) else { return self.mismatch(node, meaning, name) };
        let (least, most) = match self.dimension.filter(|_| meaning.is_vector()) {
            Some(dimension) => (dimension as u64, dimension as u64),
            None => (meaning.whole("minItems").unwrap_or(0), meaning.whole("maxItems").unwrap_or(u64::MAX)),
        };
        if !(least..=most).contains(&(items.len() as u64)) {
            let wanted = if least == most { format!("{least}") } else { format!("{least} to {most}") };
            let message = format!("`{name}` must have {wanted} entries, but has {}", items.len());
            self.report.error(node.span.clone(), message, Some(self.help(meaning, name)));
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

    fn text(&mut self, node: &Node, text: &str, meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let length = text.chars().count() as u64;
        let (least, most) = (meaning.whole("minLength").unwrap_or(0), meaning.whole("maxLength").unwrap_or(u64::MAX));
        if !(least..=most).contains(&length) {
            let message = format!("`{name}` must have {least} to {most} characters, but has {length}");
            self.report.error(node.span.clone(), message, Some(meaning.help(name)));
            return None;
        }
        let pattern = PATTERNS.iter().find(|pattern| pattern.regex == meaning.text("pattern"));
        if let Some(pattern) = pattern.filter(|pattern| !(pattern.agrees)(text)) {
            let message = format!("{} cannot be `{name}`", self.report.quoted(text));
            self.report.error(node.span.clone(), message, Some(format!("use {}", pattern.words)));
            return None;
        }
        Some(Json::String(text.to_owned()))
    }

    fn choice(&mut self, node: &Node, meaning: Meaning<'a>, name: &str, choices: &[&str]) -> Option<Json> {
        let Value::Text(given) = &node.value else {
            let message = format!("`{name}` must be text, but is {}", self.found(node));
            self.report.error(node.span.clone(), message, Some(format!("use {}", listed(choices))));
            return None;
        };
        if choices.contains(&given.as_str()) {
            return Some(Json::String(given.clone()));
        }
        self.unknown_choice(node, given, meaning, name, choices);
        None
    }

    fn unknown_choice(&mut self, node: &Node, given: &str, meaning: Meaning<'a>, name: &str, choices: &[&str]) {
        let quoted = self.report.quoted(given);
        let list = listed(choices);
        let (message, help) = if meaning.planned().any(|planned| planned == given) {
            (format!("{name} {quoted} is planned, but does not exist yet"), format!("use {list}"))
        } else {
            let help = match nearest(given, choices.iter().copied()) {
                Some(choice) if choices.len() > 1 => format!("did you mean `{choice}`? it is {list}"),
                _ => format!("use {list}"),
            };
            (format!("unknown {name} {quoted}"), help)
        };
        self.report.error(node.span.clone(), message, Some(help));
    }

    fn mismatch(&mut self, node: &Node, meaning: Meaning<'a>, name: &str) -> Option<Json> {
        let message = format!("{} must be {}, but is {}", called(name), meaning.type_in_words(), self.found(node));
        let help = (!name.contains(' ')).then(|| self.help(meaning, name));
        self.report.error(node.span.clone(), message, help);
        if meaning.is_tagged() || matches!(meaning.text("type"), "object" | "array") { self.gap() } else { None }
    }

    fn help(&self, meaning: Meaning<'a>, name: &str) -> String {
        let dimension = self.dimension.filter(|_| meaning.is_vector());
        let numbers = dimension.map(|d| format!("; {d} numbers, as the dimension is {d}"));
        format!("{}{}", meaning.help(name), numbers.unwrap_or_default())
    }

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

    fn gap<T>(&mut self) -> Option<T> {
        self.has_gaps = true;
        None
    }
}

/// A key in backticks; a phrase as it is.
fn called(name: &str) -> String {
    if name.contains(' ') { name.to_owned() } else { format!("`{name}`") }
}

fn quoted_list(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    quoted.join(", ")
}
