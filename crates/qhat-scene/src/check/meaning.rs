//! One place of the schema, references resolved, asked in the words of the checker.

use crate::suggest::listed;
use serde_json::{Map, Value as Json};

/// A schema and, where it refers to another, that one. Keywords beside a reference come first.
#[derive(Clone, Copy)]
pub(super) struct Meaning<'a> {
    pub(super) schema: &'a Json,
    target: Option<&'a Json>,
    /// The list that this is an entry of, which has the words for it.
    list: Option<&'a Json>,
}

impl<'a> Meaning<'a> {
    pub(super) fn of(root: &'a Json, schema: &'a Json) -> Self {
        let pointer = schema.get("$ref").and_then(Json::as_str).and_then(|reference| reference.strip_prefix('#'));
        Meaning { schema, target: pointer.and_then(|pointer| root.pointer(pointer)), list: None }
    }

    /// What the entries of this list are.
    pub(super) fn entry(&self, root: &'a Json) -> Option<Self> {
        Some(Meaning { list: Some(self.schema), ..Meaning::of(root, self.get("items")?) })
    }

    fn get(&self, keyword: &str) -> Option<&'a Json> {
        self.schema.get(keyword).or_else(|| self.target?.get(keyword))
    }

    pub(super) fn text(&self, keyword: &str) -> &'a str {
        self.get(keyword).and_then(Json::as_str).unwrap_or_default()
    }

    pub(super) fn number(&self, keyword: &str) -> Option<f64> {
        self.get(keyword).and_then(Json::as_f64)
    }

    pub(super) fn whole(&self, keyword: &str) -> Option<u64> {
        self.get(keyword).and_then(Json::as_u64)
    }

    fn list(&self, keyword: &str) -> impl Iterator<Item = &'a Json> + use<'a> {
        self.get(keyword).and_then(Json::as_array).into_iter().flatten()
    }

    pub(super) fn properties(&self) -> Option<&'a Map<String, Json>> {
        self.get("properties")?.as_object()
    }

    pub(super) fn required(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.list("required").filter_map(Json::as_str)
    }

    pub(super) fn planned(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.list("x-planned").filter_map(Json::as_str)
    }

    /// The kinds of a tagged table, each with its own schema.
    pub(super) fn kinds(&self) -> impl Iterator<Item = (&'a str, &'a Json)> + use<'a> {
        self.list("oneOf").filter_map(|branch| Some((branch.pointer("/properties/kind/const")?.as_str()?, branch)))
    }

    /// Whether it is a list with one number for each dimension.
    pub(super) fn is_vector(&self) -> bool {
        self.text("x-length") == "dimension"
    }

    /// Whether it is a number or the text of an expression.
    pub(super) fn is_driven(&self) -> bool {
        self.get("type").is_some_and(Json::is_array)
    }

    pub(super) fn is_tagged(&self) -> bool {
        self.kinds().next().is_some()
    }

    /// The texts a value may be, where only some are allowed.
    pub(super) fn choices(&self) -> Option<Vec<&'a str>> {
        let documented = self.list("oneOf").filter_map(|branch| branch.get("const"));
        let choices: Vec<&str> = self.list("enum").chain(documented).filter_map(Json::as_str).collect();
        (!choices.is_empty()).then_some(choices)
    }

    pub(super) fn type_in_words(&self) -> &'static str {
        match self.text("type") {
            "object" => "a table",
            "array" => "a list",
            "string" => "text",
            "integer" => "a whole number",
            "number" => "a number",
            "boolean" => "true or false",
            _ if self.is_tagged() => "a table",
            _ if self.is_driven() => "a number or an expression of t",
            _ => "text",
        }
    }

    /// What a key is, in the words of the schema, with what it may be and what it is if left out.
    pub(super) fn help(&self, name: &str) -> String {
        let name = name.split('[').next().unwrap_or(name);
        let of_list = self.list.and_then(|list| list.get("description")).and_then(Json::as_str);
        let description = of_list.unwrap_or_else(|| self.text("description"));
        let description = description.split_whitespace().collect::<Vec<_>>().join(" ");
        let mut letters = description.trim_end_matches('.').chars();
        let first = letters.next().map(|first| first.to_lowercase().collect::<String>()).unwrap_or_default();
        let allowed = self.choices().map(|choices| format!(", {}", listed(&choices))).unwrap_or_default();
        let default = match self.get("default") {
            Some(Json::String(text)) => format!("; `{text}` if left out"),
            Some(value @ (Json::Number(_) | Json::Bool(_))) => format!("; {value} if left out"),
            _ => String::new(),
        };
        format!("`{name}` is {first}{}{allowed}{default}", letters.as_str())
    }
}
