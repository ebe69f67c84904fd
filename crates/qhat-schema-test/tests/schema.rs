//! The published schema agrees with the reader: an independent validator and the reader give the same verdict on
//! thousands of scenes, each of which differs from a valid scene at a single place.

use qhat_scene::{Format, SceneErrors, json_schema, load, shipped};
use serde_json::{Value, json};

fn every_key() -> [Value; 3] {
    [
        include_str!("../../qhat-scene/tests/every-key.toml"),
        include_str!("../../qhat-scene/tests/every-key-in-space.toml"),
        include_str!("../../qhat-scene/tests/every-contact.toml"),
    ]
    .map(|text| toml::from_str(text).unwrap())
}

fn read(scene: &Value) -> Result<(), SceneErrors> {
    load(&scene.to_string(), "scene.json", Format::Json).map(|_| ())
}

#[test]
fn the_schema_is_of_draft_2020_12_and_accepts_the_shipped_scenes() {
    let schema = json_schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    for scene in shipped() {
        let value: Value = toml::from_str(scene.text).unwrap();
        assert!(validator.is_valid(&value), "{}", scene.name);
    }
    for scene in every_key() {
        assert!(validator.is_valid(&scene));
        read(&scene).unwrap_or_else(|errors| panic!("{errors}"));
    }
}

/// The scene with a single value replaced or removed, for every place and every replacement.
fn variants(scene: &Value) -> Vec<Value> {
    let mut places = Vec::new();
    collect_places(scene, String::new(), &mut places);
    let others = [
        json!(null),
        json!(true),
        json!("x"),
        json!(-1),
        json!(0),
        json!(0.5),
        json!(3),
        json!(1e-17),
        json!([]),
        json!({}),
    ];
    let mut variants = Vec::new();
    for place in &places {
        for other in &others {
            let mut variant = scene.clone();
            *variant.pointer_mut(place).unwrap() = other.clone();
            variants.push(variant);
        }
        let (parent, key) = place.rsplit_once('/').unwrap_or_default();
        let mut without = scene.clone();
        match without.pointer_mut(parent) {
            Some(Value::Object(table)) => drop(table.remove(key)),
            Some(Value::Array(list)) => drop(list.remove(key.parse().unwrap())),
            _ => {}
        }
        variants.push(without);
        let mut with_more = scene.clone();
        match with_more.pointer_mut(place) {
            Some(Value::Object(table)) => drop(table.insert("unheard_of".into(), json!(1))),
            Some(Value::Array(list)) => list.push(json!(1)),
            _ => {}
        }
        variants.push(with_more);
    }
    variants
}

fn collect_places(value: &Value, place: String, places: &mut Vec<String>) {
    match value {
        Value::Object(table) => {
            table.iter().for_each(|(key, value)| collect_places(value, format!("{place}/{key}"), places))
        }
        Value::Array(list) => {
            list.iter()
                .enumerate()
                .for_each(|(index, value)| collect_places(value, format!("{place}/{index}"), places));
        }
        _ => {}
    }
    places.push(place);
}

/// Parts of messages about two keys that contradict each other. A schema cannot express such rules.
const BETWEEN_KEYS: [&str; 71] = [
    "the parameter `",
    " beyond what ",
    "the shortest length, the longest, or both",
    "must be more than the shortest",
    "no direction that can be measured",
    "the size of a box",
    "there is no ",
    "is given twice",
    "is given to two",
    "cannot be connected to itself",
    "must have 2 entries, but has 3",
    "must have 3 entries, but has 2",
    "cannot have a velocity",
    "start 0 m apart",
    "but that id is taken",
    "must begin with the lower end",
    "no particles",
    "start at the same place",
    "the edges of a body",
    "the particles of a body",
    "number in the plane",
    "a body without a moment of inertia",
    "the mass of a body",
    "none of its principal moments",
    "must have 2 entries, but has 1",
    "the expression is empty",
    "is not a finite number at the start",
    "depends on no particle",
    "is the id of a particle, too",
    "its scale must be given",
    "is named twice",
    " charges for ",
    "in two dimensions needs an `outline`",
    "an arm of this hinge",
    "the gradient of the wind",
    "this rope has",
    "weight 0",
    "without teeth",
    "wheels that mesh",
    "needs a length",
    "cluster cannot be held",
    "one corner of a polygon",
    "three different corners",
    "not closed",
    "turn one of them round",
    "from one particle to another",
    "may depend on nothing but t",
    "is given by `",
    "needs a `range`",
    "needs an `axis`",
    "can have one weight",
    "a weight of 0",
    "must not be zero",
    "but goes from",
    "of a curve are at one place",
    "a curve needs",
    "gives no direction",
    "is rigid and held in the form",
    "has no length left between",
    "has no axis in two",
    "no plane to be on",
    "is not finite everywhere",
    "needs a radius",
    "a wire of straight pieces needs",
    "are at one place, or too far apart",
    "folds back by 180°",
    "too large for the corner",
    "but this curve is given by",
    "of a gas must be positive",
    "a gas must fill more than nothing",
    "numbers in space, but has",
];

#[test]
fn long_the_reader_and_the_schema_agree() {
    let schema = json_schema();
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    let variants: Vec<Value> = every_key().iter().flat_map(variants).collect();
    assert!(variants.len() > 1000);
    for variant in variants {
        match (validator.is_valid(&variant), read(&variant)) {
            (true, Ok(())) | (false, Err(_)) => {}
            (true, Err(errors)) => {
                for error in &errors.errors {
                    let is_between = BETWEEN_KEYS.iter().any(|phrase| error.message.contains(phrase));
                    assert!(is_between, "the schema allows what the reader refuses:\n{error}");
                }
            }
            (false, Ok(())) => {
                let complaint = validator.iter_errors(&variant).next().map(|error| error.to_string());
                panic!("the reader takes what the schema refuses: {complaint:?}\n{variant:#}");
            }
        }
    }
}
