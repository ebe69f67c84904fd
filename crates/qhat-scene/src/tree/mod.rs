//! One tree of values for TOML and JSON, each value with its place in the text.

pub(crate) mod json;
pub(crate) mod toml;

use std::ops::Range;

/// A value and its place in the text.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// The bytes of the value in the text.
    pub(crate) span: Range<usize>,
    pub(crate) value: Value,
}

/// A value of a scene. `Other` names a kind of value that no scene may hold, such as a date.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    /// A number; nan or infinite where the text says so or the number is too large, which `check` refuses.
    Number(f64),
    Truth(bool),
    List(Vec<Node>),
    Table(Vec<Entry>),
    Other(&'static str),
}

/// One key of a table with its value.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Range<usize>,
    pub(crate) node: Node,
}

impl Node {
    /// The value under a key of a table.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Table(entries) => entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node),
            _ => None,
        }
    }

    /// The value under a key, or the table where the key is left out: the place for an error about the key.
    pub(crate) fn key(&self, key: &str) -> &Node {
        self.get(key).unwrap_or(self)
    }

    /// The entry of a list, or the list where there is no such entry: the place for an error about the entry.
    pub(crate) fn item(&self, index: usize) -> &Node {
        match &self.value {
            Value::List(items) => items.get(index).unwrap_or(self),
            _ => self,
        }
    }
}
