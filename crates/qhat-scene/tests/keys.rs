//! Every key of the schema has a description in the schema, a place in the guide and a use in the scenes of these
//! tests.

use qhat_scene::json_schema;
use serde_json::Value;
use std::collections::BTreeSet;

fn every_key() -> [Value; 3] {
    let texts =
        [include_str!("every-key.toml"), include_str!("every-key-in-space.toml"), include_str!("every-contact.toml")];
    texts.map(|text| toml::from_str(text).unwrap())
}

/// The keys of all tables of a scene.
fn keys_of(scene: &Value, found: &mut BTreeSet<String>) {
    match scene {
        Value::Object(table) => {
            found.extend(table.keys().cloned());
            table.values().for_each(|value| keys_of(value, found));
        }
        Value::Array(list) => list.iter().for_each(|value| keys_of(value, found)),
        _ => {}
    }
}

/// The keys of all tables of the schema.
fn keys(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(table) => {
            if let Some(Value::Object(properties)) = table.get("properties") {
                found.extend(properties.keys().cloned());
            }
            table.values().for_each(|value| keys(value, found));
        }
        Value::Array(list) => list.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn the_guide_and_the_test_scene_name_every_key() {
    let mut known = BTreeSet::new();
    keys(&json_schema(), &mut known);
    let mut used = BTreeSet::new();
    every_key().iter().for_each(|scene| keys_of(scene, &mut used));
    let guide = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene-file.md")).unwrap();
    for key in known {
        assert!(guide.contains(&format!("`{key}`")), "docs/scene-file.md does not name `{key}`");
        assert!(used.contains(&key), "every-key.toml lacks `{key}`");
    }
}

#[test]
fn every_key_is_described() {
    fn walk(schema: &Value) {
        let Value::Object(table) = schema else {
            if let Value::Array(list) = schema {
                list.iter().for_each(walk);
            }
            return;
        };
        if let Some(Value::Object(properties)) = table.get("properties") {
            for (key, property) in properties {
                assert!(key == "kind" || property.get("description").is_some(), "`{key}` has no words");
            }
        }
        table.values().for_each(walk);
    }
    walk(&json_schema());
}
