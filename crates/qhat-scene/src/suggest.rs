//! Suggestions for a misspelt name, and lists of names in words.

use strsim::damerau_levenshtein;

/// The most names that are compared with a misspelt one. A hostile scene has a million names.
const COMPARED: usize = 2000;

/// The name nearest to the given one, where the given one could be a misspelling of it.
pub(crate) fn nearest<'a>(given: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let letters = given.chars().count();
    if letters < 2 {
        return None; // every other letter is one edit away
    }
    // A word with one edit in three letters can still be recognised; with more it is another word.
    let most = (letters / 3).clamp(1, 3);
    let near = names.take(COMPARED).filter(|name| name.chars().count().abs_diff(letters) <= most);
    let scored = near.map(|name| (damerau_levenshtein(&given.to_lowercase(), &name.to_lowercase()), name));
    scored.filter(|(distance, _)| *distance <= most).min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}

/// The names in backticks: `a`, `b` or `c`.
pub(crate) fn listed(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.as_slice() {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}
