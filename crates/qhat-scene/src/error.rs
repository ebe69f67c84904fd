//! What is wrong with a scene, and where.

use std::fmt;
use std::ops::Range;

/// Everything that is wrong with a scene, in the order of the text.
///
/// Displayed as `file:line:column: message`, the line with the offending text underlined, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneErrors {
    /// The errors; at least one.
    pub errors: Vec<SceneError>,
    /// Whether reading stopped, after the first twenty, before everything was looked at.
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

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SceneError {
    /// The name of the text, as it was given to [`crate::load`].
    pub source_name: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The offending bytes of the text; empty where something is missing altogether.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// The line, cut where it is long, and the offending text underlined.
    pub excerpt: String,
    /// What to write instead.
    pub help: Option<String>,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let SceneError { source_name, line, column, message, excerpt, help, .. } = self;
        write!(f, "{source_name}:{line}:{column}: {message}\n{excerpt}")?;
        help.as_ref().map_or(Ok(()), |help| write!(f, "\nhelp: {help}"))
    }
}
