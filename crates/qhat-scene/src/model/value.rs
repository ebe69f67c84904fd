//! Small values that many tables share: ids, names, vectors.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ID: &str = r"^[\p{Alphabetic}_][\p{Alphabetic}\p{N}_]{0,63}$";
const NAME: &str = r"^[\p{Alphabetic}_][\p{Alphabetic}\p{N}_.()-]{0,127}$";

/// A pattern of the schema, the function that checks it, and the pattern in words.
pub(crate) struct Pattern {
    pub(crate) regex: &'static str,
    pub(crate) agrees: fn(&str) -> bool,
    pub(crate) words: &'static str,
}

/// All patterns of the schema.
pub(crate) const PATTERNS: [Pattern; 2] = [
    Pattern { regex: ID, agrees: is_id, words: "letters, digits and `_`, a letter or `_` first, 64 at most" },
    Pattern {
        regex: NAME,
        agrees: is_name,
        words: "letters, digits and `_ . - ( )`, a letter or `_` first, 128 at most",
    },
];

/// The id of a particle: an identifier, so that an expression can name the particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Id(#[schemars(extend("pattern" = ID))] pub(crate) String);

/// The name of a constraint.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Name(#[schemars(extend("pattern" = NAME))] pub(crate) String);

/// One number for each dimension.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(transparent)]
pub(crate) struct Vector(#[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))] pub(crate) Vec<f64>);

impl Vector {
    /// The vector with three components, as the engine takes points: z = 0 in two dimensions.
    pub(crate) fn padded(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.0.get(k).copied().unwrap_or(0.0))
    }
}

fn is_id(text: &str) -> bool {
    is_word(text, 64, |letter| is_letter(letter) || letter == '_')
}

fn is_name(text: &str) -> bool {
    is_word(text, 128, |letter| is_letter(letter) || "_.()-".contains(letter))
}

fn is_word(text: &str, longest: usize, rest: impl Fn(char) -> bool) -> bool {
    let first = text.chars().next().is_some_and(|letter| letter.is_alphabetic() || letter == '_');
    first && text.chars().all(rest) && text.chars().count() <= longest
}

fn is_letter(letter: char) -> bool {
    letter.is_alphanumeric()
}
