//! The errors of a scene, each with its place in the text.

use std::fmt;
use std::ops::Range;

/// The errors of a scene, in the order of the text.
///
/// Each is displayed as `file:line:column: message`, the line with the mistake underlined, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneErrors {
    /// The errors; at least one.
    pub errors: Vec<SceneError>,
    /// Whether reading stopped before the end, after twenty errors.
    pub more: bool,
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.errors.iter().enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            error.fmt(f)?;
        }
        if self.more { f.write_str("\n\nThere may be more: reading stopped after these.") } else { Ok(()) }
    }
}

/// One error of a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneError {
    /// The name of the text, as given to [`crate::load`].
    pub source_name: String,
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// The bytes of the text that are at fault; empty where something is missing.
    pub span: Range<usize>,
    /// The mistake, in one sentence.
    pub message: String,
    /// The line, cut where it is long, with the mistake underlined.
    pub excerpt: String,
    /// The help: what to write instead.
    pub help: Option<String>,
    /// The lines of all other places with the same mistake, in the order in which they were found.
    pub also: Vec<usize>,
}

/// The most lines with the same mistake that are listed; of the others only the number is told.
const LISTED: usize = 5;

impl SceneError {
    /// The other places with the same mistake, as the end of the message; empty where there is none.
    fn elsewhere(&self) -> String {
        let list = |lines: &[usize]| lines.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        match self.also.as_slice() {
            [] => String::new(),
            [line] => format!(" (and the same in line {line})"),
            lines if lines.len() <= LISTED => format!(" (and the same in lines {})", list(lines)),
            lines => format!(" (and the same in lines {} and {} more)", list(&lines[..LISTED]), lines.len() - LISTED),
        }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SceneError { source_name, line, column, message, excerpt, help, .. } = self;
        write!(f, "{source_name}:{line}:{column}: {message}{}\n{excerpt}", self.elsewhere())?;
        help.as_ref().map_or(Ok(()), |help| write!(f, "\nhelp: {help}"))
    }
}
