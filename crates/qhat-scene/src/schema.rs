//! The JSON Schema of a scene, made from the types of the model.

use crate::model::Document;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{Schema, SchemaGenerator};
use serde_json::Value;
use std::sync::LazyLock;

/// The JSON Schema of a scene file, draft 2020-12.
///
/// The reader checks scenes against this schema. Its own keyword `x-length` says that a list has one entry for each
/// dimension. Conditions between keys (an id that must exist, a fixed particle that must not move) are not in the
/// schema. Where a number stands, the schema allows a text of parameters, whose value the reader checks.
pub fn json_schema() -> Value {
    let mut schema = schema().clone();
    if let Some(parts) = schema.as_object_mut() {
        // Parameters themselves and the dimension are numbers.
        for (key, part) in parts.iter_mut().filter(|(key, _)| key.as_str() != "$defs") {
            if let (true, Value::Object(properties)) = (key == "properties", &mut *part) {
                let others =
                    properties.iter_mut().filter(|(key, _)| !matches!(key.as_str(), "dimension" | "parameters"));
                others.for_each(|(_, property)| allow_texts(property));
            }
        }
        if let Some(Value::Object(definitions)) = parts.get_mut("$defs") {
            let others =
                definitions.iter_mut().filter(|(key, _)| !matches!(key.as_str(), "Parameter" | "ParameterTable"));
            others.for_each(|(_, definition)| allow_texts(definition));
        }
    }
    schema
}

/// Allows texts wherever numbers stand. The limits of a number do not apply to a text.
fn allow_texts(schema: &mut Value) {
    match schema {
        Value::Object(keywords) => {
            if let Some(Value::String(kind)) = keywords.get("type")
                && matches!(kind.as_str(), "number" | "integer")
            {
                let kinds = vec![Value::from(kind.as_str()), Value::from("string")];
                keywords.insert("type".into(), kinds.into());
            }
            keywords.iter_mut().filter(|(key, _)| key.as_str() != "default").for_each(|(_, it)| allow_texts(it));
        }
        Value::Array(list) => list.iter_mut().for_each(allow_texts),
        _ => {}
    }
}

pub(crate) fn schema() -> &'static Value {
    static SCHEMA: LazyLock<Value> = LazyLock::new(|| {
        let settings = SchemaSettings::draft2020_12().with_transform(NoNull);
        SchemaGenerator::new(settings).into_root_schema_for::<Document>().to_value()
    });
    &SCHEMA
}

/// Takes null out of the schema. TOML has no null: a key without a value is left out.
#[derive(Clone, Debug)]
struct NoNull;

impl Transform for NoNull {
    fn transform(&mut self, schema: &mut Schema) {
        if let Some(Value::Array(types)) = schema.get_mut("type") {
            types.retain(|name| name != "null");
            if let [only] = types.as_slice() {
                let only = only.clone();
                schema.insert("type".into(), only);
            }
        }
        if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
            choices.retain(|choice| choice.get("type").is_none_or(|name| name != "null"));
            if let [Value::Object(only)] = choices.as_mut_slice() {
                let only = std::mem::take(only);
                schema.remove("anyOf");
                for (keyword, value) in only {
                    schema.ensure_object().entry(keyword).or_insert(value);
                }
            }
        }
        if schema.get("default") == Some(&Value::Null) {
            schema.remove("default");
        }
        transform_subschemas(self, schema);
    }
}
