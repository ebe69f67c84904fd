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

/// One step on the way from the top of a tree to a value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step<'a> {
    /// A key of a table.
    Key(&'a str),
    /// A place in a list, from 0.
    Place(usize),
}

impl Node {
    /// The entries of a table; none where the value is no table.
    pub(crate) fn entries(&self) -> &[Entry] {
        if let Value::Table(entries) = &self.value { entries } else { &[] }
    }

    /// The value under a key of a table.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries().iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    /// The value under a key of a table, to be changed.
    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        let Value::Table(entries) = &mut self.value else { return None };
        entries.iter_mut().find(|entry| entry.key == key).map(|entry| &mut entry.node)
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
