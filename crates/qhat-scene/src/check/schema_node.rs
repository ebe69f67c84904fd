//! A node of the schema with its reference resolved, and the questions that the checker asks of it.

use crate::suggest::listed;
use serde_json::{Map, Value as Json};

/// A node of the schema and, where it is a reference, the node that it refers to. Keywords beside a reference come
/// first.
#[derive(Clone, Copy)]
pub(super) struct SchemaNode<'a> {
    node: &'a Json,
    target: Option<&'a Json>,
    /// The list whose entries this node describes; the description of the list holds for its entries.
    list: Option<&'a Json>,
}

impl<'a> SchemaNode<'a> {
    pub(super) fn of(root: &'a Json, node: &'a Json) -> Self {
        let pointer = node.get("$ref").and_then(Json::as_str).and_then(|reference| reference.strip_prefix('#'));
        SchemaNode { node, target: pointer.and_then(|pointer| root.pointer(pointer)), list: None }
    }

    /// The schema of the entries of this list.
    pub(super) fn entry(&self, root: &'a Json) -> Option<Self> {
        Some(SchemaNode { list: Some(self.list.unwrap_or(self.node)), ..SchemaNode::of(root, self.get("items")?) })
    }

    /// The schema of the values of this table, where its keys are names that the scene gives.
    pub(super) fn names(&self, root: &'a Json) -> Option<Self> {
        let inner = self.get("additionalProperties").filter(|inner| inner.is_object())?;
        Some(SchemaNode { list: Some(self.node), ..SchemaNode::of(root, inner) })
    }

    /// The schemas of the allowed types, where there are several.
    pub(super) fn alternatives(&self, root: &'a Json) -> impl Iterator<Item = Self> + use<'a> {
        let words = self.node;
        self.list("anyOf").map(move |node| SchemaNode { list: Some(words), ..SchemaNode::of(root, node) })
    }

    /// Whether this is the node at this place of the schema.
    pub(super) fn is(&self, node: &Json) -> bool {
        std::ptr::eq(self.node, node)
    }

    fn get(&self, keyword: &str) -> Option<&'a Json> {
        self.node.get(keyword).or_else(|| self.target?.get(keyword))
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

    /// The kinds of a tagged table, each with its own schema.
    pub(super) fn kinds(&self) -> impl Iterator<Item = (&'a str, &'a Json)> + use<'a> {
        self.list("oneOf").filter_map(|branch| Some((branch.pointer("/properties/kind/const")?.as_str()?, branch)))
    }

    /// Whether this is a list with one number for each dimension.
    pub(super) fn is_vector(&self) -> bool {
        self.text("x-length") == "dimension"
    }

    /// Whether this is a number or the text of an expression.
    pub(super) fn is_number_or_text(&self) -> bool {
        self.list("type").filter_map(Json::as_str).eq(["number", "string"])
    }

    /// Whether this is a table whose `kind` determines its keys.
    pub(super) fn is_tagged(&self) -> bool {
        self.kinds().next().is_some()
    }

    /// The allowed texts, where the schema lists them.
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
            _ if self.is_number_or_text() => "a number or an expression of t",
            _ if self.list("anyOf").any(|node| node.get("type").and_then(Json::as_str) == Some("number")) => {
                "a number or a table"
            }
            _ if self.list("anyOf").next().is_some() => "text or a list of texts",
            _ => "text",
        }
    }

    /// The help for a key: its description in the schema, the allowed texts, and the default.
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
