//! Help for unknown keys at the top of a scene: the place where the thing is written that the key names.

use super::SchemaNode;
use serde_json::Value as Json;

/// Words that people try at the top of a scene and that are no key or kind of it, with their help.
const WORDS: [(&[&str], &str); 7] = [
    (
        &["rod", "rods", "link", "links", "stick", "sticks", "edge", "edges"],
        "a rod is a constraint of kind `distance`: write `[[constraints]]` and `kind = \"distance\"`",
    ),
    (
        &["joint", "joints", "pin", "pins", "hinge", "hinges"],
        "rods that share a particle are joined there; a joint that stays at a point is a constraint of kind `nail`: \
         write `[[constraints]]` and `kind = \"nail\"`",
    ),
    (
        &["motor", "motors", "drive", "drives"],
        "a motor is a constraint of kind `angle` with an expression of t as its `angle`: \
         write `[[constraints]]` and `kind = \"angle\"`",
    ),
    (
        &["ground", "floor", "wall", "walls", "contact", "contacts"],
        "ground is a constraint of kind `half-space`: write `[[constraints]]` and `kind = \"half-space\"`",
    ),
    (
        &["settings", "simulation", "solver", "options", "config", "time", "dt", "timestep", "time_step"],
        "the settings of a run stand in `[step]`: `h` is the step, `duration` the time to simulate, \
         `integrator` the method",
    ),
    (
        &["mass", "masses", "node", "nodes", "point", "points"],
        "a point mass is a particle: write `[[particles]]` with `id`, `at` and `mass`",
    ),
    (&["variables", "constants", "params"], "numbers with a name stand in `[parameters]`"),
];

/// The lists whose entries have a kind, and the noun for one entry.
const LISTS: [(&str, &str); 4] =
    [("constraints", "a constraint"), ("loads", "a load"), ("bodies", "a body"), ("generate", "a block")];

/// The help for a key that is unknown at the top of a scene, where the key names something that stands elsewhere.
pub(super) fn help(root: &Json, key: &str) -> Option<String> {
    let words = WORDS.iter().find(|(words, _)| words.contains(&key));
    words.map(|(_, help)| (*help).to_owned()).or_else(|| in_a_table(root, key)).or_else(|| kind(root, key))
}

/// The help for a key of another table, as `gravity` is a key of `[forces]`.
fn in_a_table(root: &Json, key: &str) -> Option<String> {
    ["step", "forces", "feedback"].into_iter().find_map(|table| {
        let keys = property(root, table)?.properties()?;
        let node = SchemaNode::of(root, keys.get(key)?);
        Some(format!("`{key}` stands in `[{table}]`; {}", node.help(key)))
    })
}

/// The help for a kind, in the singular or the plural, as `nails` are constraints of kind `nail`.
fn kind(root: &Json, key: &str) -> Option<String> {
    let singular = key.strip_suffix('s').unwrap_or(key).replace('_', "-");
    LISTS.into_iter().find_map(|(list, noun)| {
        let entry = property(root, list)?.entry(root)?;
        let (kind, _) = entry.kinds().find(|(kind, _)| *kind == key || *kind == singular)?;
        Some(format!("`{kind}` is the kind of {noun}: write `[[{list}]]` and `kind = \"{kind}\"`"))
    })
}

fn property<'a>(root: &'a Json, key: &str) -> Option<SchemaNode<'a>> {
    Some(SchemaNode::of(root, root.get("properties")?.get(key)?))
}
