//! Printing on stdout. A reader that has gone away (`qhat scenes | head -1`) is no error: what it wanted, it has.

use crate::failure::Failure;
use qhat::Solver;
use serde::{Serialize, Serializer};
use std::fmt::Display;
use std::io::{self, Write};

/// Prints bytes as they are.
pub(crate) fn bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::io("cannot write to stdout", &error)),
        _ => Ok(()),
    }
}

/// Prints text and ends its last line.
pub(crate) fn text(text: &str) -> Result<(), Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    bytes(format!("{text}{end}").as_bytes())
}

/// Prints a value as indented JSON.
pub(crate) fn json(value: &impl Serialize) -> Result<(), Failure> {
    text(&to_json(value)?)
}

/// A value as indented JSON.
pub(crate) fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map_err(|error| Failure::input(format!("cannot write JSON: {error}")))
}

/// Text that moves nothing on a terminal: names come from scenes, and a scene may come from anywhere.
pub(crate) fn plain(text: &str) -> String {
    let fit = |character: char| match character {
        '\n' => character,
        // These turn the direction of writing, so that a line could say what it does not.
        '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => '\u{FFFD}',
        character if character.is_control() => '\u{FFFD}',
        character => character,
    };
    text.chars().map(fit).collect()
}

/// A number of things in words.
pub(crate) fn count(number: usize, thing: &str) -> String {
    if number == 1 { format!("1 {thing}") } else { format!("{number} {thing}s") }
}

/// The size of something that should be nothing.
pub(crate) fn small(number: f64) -> String {
    if number == 0.0 { "0".into() } else { format!("{:.1e}", number.abs()) }
}

/// Prints pairs of a word and what it says, the second column aligned; `title` stands above.
pub(crate) fn table(title: &str, lines: &[(&str, String)]) -> Result<(), Failure> {
    let width = lines.iter().map(|(word, _)| word.chars().count()).max().unwrap_or(0);
    let mut out = format!("{title}\n");
    for (word, what) in lines {
        // Lines of what is said stay in their column.
        let what = what.replace('\n', &format!("\n  {:width$}  ", ""));
        out += &format!("  {word:width$}  {what}\n");
    }
    text(&plain(&out))
}

/// A path to the multipliers, as the end of a sentence.
pub(crate) fn path(solver: Solver) -> &'static str {
    match solver {
        Solver::Rows => "by the rows of A",
        Solver::Chains => "in lanes",
        Solver::EndOfStep => "at the end of each step",
        _ => "by another path",
    }
}

/// For what has one name, in JSON as on paper.
pub(crate) fn display<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}
