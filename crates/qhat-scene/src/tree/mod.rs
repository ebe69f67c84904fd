//! What TOML and JSON have in common: one tree of values, each with the bytes of the text it was read from.

pub(crate) mod json;
pub(crate) mod toml;

use std::ops::Range;

/// A value and where it stands in the text.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// Its bytes in the text.
    pub(crate) span: Range<usize>,
    pub(crate) value: Value,
}

/// The kinds of value a scene may hold; `Other` names one that it may not.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    /// nan and infinite where the text says so or the number is too large: the reader refuses them.
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

    /// The place to point at for a key: its value, or the table where the key was left out.
    pub(crate) fn key(&self, key: &str) -> &Node {
        self.get(key).unwrap_or(self)
    }

    /// The place to point at for an entry of a list.
    pub(crate) fn item(&self, index: usize) -> &Node {
        match &self.value {
            Value::List(items) => items.get(index).unwrap_or(self),
            _ => self,
        }
    }
}
