//! Printing on stdout. A closed pipe (`qhat scenes | head -1`) is no error, because the reader asked for no more.

use crate::failure::Failure;
use qhat::Solver;
use qhat_scene::fitted;
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

/// A number of things in words.
pub(crate) fn count(number: usize, thing: &str) -> String {
    if number == 1 { format!("1 {thing}") } else { format!("{number} {thing}s") }
}

/// The size of a number that should be zero.
pub(crate) fn small(number: f64) -> String {
    if number == 0.0 { "0".into() } else { format!("{:.1e}", number.abs()) }
}

/// Prints a title and below it lines of two columns, the second aligned.
pub(crate) fn table(title: &str, lines: &[(&str, String)]) -> Result<(), Failure> {
    let width = lines.iter().map(|(word, _)| word.chars().count()).max().unwrap_or(0);
    let mut out = format!("{title}\n");
    for (word, what) in lines {
        // Further lines of a text stay in its column.
        let what = what.replace('\n', &format!("\n  {:width$}  ", ""));
        out += &format!("  {word:width$}  {what}\n");
    }
    text(&fitted(&out))
}

/// The solver of the multipliers, as the end of a sentence.
pub(crate) fn path(solver: Solver) -> &'static str {
    match solver {
        Solver::Rows => "by the rows of A",
        Solver::Chains => "in lanes",
        Solver::EndOfStep => "at the end of each step",
        _ => "by another path",
    }
}

/// Serializes a value as the text that `Display` gives it.
pub(crate) fn display<S: Serializer>(value: &impl Display, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(value)
}
