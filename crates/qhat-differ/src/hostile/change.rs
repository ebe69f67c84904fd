//! Changes of scenes that keep their structure: numbers, keys, types, ids, expressions, whole parts of other scenes.

use super::expression::expression;
use crate::random::Random;
use serde_json::{Map, Number, Value};

/// Numbers at the ends of their ranges, and ones that programs take for others.
const EXTREMES: [f64; 22] = [
    0.0, -0.0, 1.0, -1.0, 2.0, 3.0, 0.5, 1e-320, 5e-324, 1e-300, 1e-15, 1e-9, 1e-4, 1e4, 1e6, 1e9, 1e12, 1e15, 1e100,
    1e300, 1.7e308, -1e308,
];

/// The ids of the particles of a scene.
fn ids(scene: &Value) -> Vec<String> {
    let particles = scene.get("particles").and_then(Value::as_array);
    let named = particles.into_iter().flatten().filter_map(|particle| particle.get("id")?.as_str());
    named.map(str::to_owned).collect()
}

/// A number of nodes below and including this one.
fn size(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(size).sum(),
        Value::Object(entries) => entries.values().map(size).sum(),
        _ => 0,
    }
}

/// The node with a number, counted as [`size`] counts.
fn node(value: &mut Value, number: usize) -> &mut Value {
    if number == 0 {
        return value;
    }
    let mut left = number - 1;
    let parts: Box<dyn Iterator<Item = &mut Value>> = match value {
        Value::Array(items) => Box::new(items.iter_mut()),
        Value::Object(entries) => Box::new(entries.values_mut()),
        _ => unreachable!("the number is below the size"),
    };
    for part in parts {
        let own = size(part);
        if left < own {
            return node(part, left);
        }
        left -= own;
    }
    unreachable!("the number is below the size")
}

/// Changes one place of a scene; `other` is a scene whose parts may come in.
pub(super) fn change(random: &mut Random, scene: &mut Value, other: &mut Value) {
    let names = ids(scene);
    let place = random.below(size(scene));
    // A part of the other scene, for the changes that bring one in.
    let part = {
        let count = size(other);
        node(other, random.below(count)).clone()
    };
    let target = node(scene, place);
    match target {
        Value::Number(number) if random.chance(0.85) => {
            let value = number.as_f64().unwrap_or(1.0);
            let changed = match random.below(6) {
                0 | 1 => *random.pick(&EXTREMES),
                2 => value * random.decade(1e-12, 1e12),
                3 => value * (1.0 + random.between(-1e-6, 1e-6)),
                4 => -value,
                _ => random.between(-3.0, 3.0),
            };
            *target = number_of(changed);
        }
        Value::String(text) if random.chance(0.85) => {
            *text = match random.below(4) {
                0 if !names.is_empty() => random.pick(&names).clone(),
                1 | 2 => expression(random, &names),
                _ => format!("{text}{}", random.pick(&["", " ", "x", "é", "\u{0}", "0"])),
            };
        }
        Value::Bool(flag) if random.chance(0.85) => *flag = !*flag,
        Value::Array(items) if random.chance(0.9) && !items.is_empty() => list(random, items, part),
        Value::Object(entries) if random.chance(0.9) && !entries.is_empty() => table(random, entries, part, &names),
        _ => *target = other_type(random, target, part),
    }
}

fn number_of(value: f64) -> Value {
    // A number that is not finite has no JSON; the byte changes write such.
    Number::from_f64(value).map_or(Value::Null, Value::Number)
}

fn list(random: &mut Random, items: &mut Vec<Value>, part: Value) {
    let [i, j] = [random.below(items.len()), random.below(items.len())];
    match random.below(6) {
        0 => drop(items.remove(i)),
        1 => items.push(items[i].clone()),
        2 => items.swap(i, j),
        3 => items[i] = items[j].clone(),
        4 => items.insert(i, part),
        // Long lists, up to thousands of equal entries.
        _ => {
            let times = *random.pick(&[2, 10, 300]);
            if size(&items[i]) * times < 20_000 {
                items.extend(std::iter::repeat_n(items[i].clone(), times));
            }
        }
    }
}

fn table(random: &mut Random, entries: &mut Map<String, Value>, part: Value, names: &[String]) {
    let keys: Vec<String> = entries.keys().cloned().collect();
    let key = random.pick(&keys).clone();
    match random.below(6) {
        0 => drop(entries.remove(&key)),
        1 => {
            if let Some(value) = entries.remove(&key) {
                entries.insert(format!("{key}{}", random.pick(&["s", "_", " ", ""])), value);
            }
        }
        2 => drop(entries.insert(key, part)),
        3 => {
            // Every entry of the other part that is a table, so that kinds of constraints mix.
            if let Value::Object(others) = part {
                entries.extend(others);
            }
        }
        4 => {
            let value = Value::String(expression(random, names));
            entries.insert(key, value);
        }
        _ => {
            let value = entries[&key].clone();
            entries.insert(random.pick(&keys).clone(), value);
        }
    }
}

fn other_type(random: &mut Random, value: &Value, part: Value) -> Value {
    match random.below(8) {
        0 => Value::Array(vec![value.clone()]),
        1 => Value::Object(Map::from_iter([("a".to_owned(), value.clone())])),
        2 => Value::Null,
        3 => Value::Bool(random.chance(0.5)),
        4 => number_of(*random.pick(&EXTREMES)),
        5 => Value::String(value.to_string()),
        6 => {
            let deep = |inner, _| Value::Array(vec![inner]);
            (0..*random.pick(&[5, 100])).fold(value.clone(), deep)
        }
        _ => part,
    }
}

/// Changes bytes of a text: some removed, some put in, some written twice.
pub(super) fn change_bytes(random: &mut Random, bytes: &mut Vec<u8>) {
    const SYNTAX: &[u8] = b"[]{}\",.=:-+eE0123456789\n #'\\ntafiulse_\xff\0";
    let start = random.below(bytes.len() + 1);
    let end = (start + random.below(6)).min(bytes.len());
    let put: Vec<u8> = (0..random.below(4)).map(|_| *random.pick(SYNTAX)).collect();
    if random.chance(0.2) {
        let far = (start + random.below(200)).min(bytes.len());
        let copied = bytes[start..far].to_vec();
        bytes.splice(end..end, copied);
    } else {
        bytes.splice(start..end, put);
    }
}
