//! Why an expression was refused: where, what, and what to write instead.

use std::ops::Range;
use thiserror::Error;

/// Why an expression was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct ExpressionError {
    /// The part concerned, in bytes of the text; on borders of characters, empty at its end.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to write instead, where that is known.
    pub help: Option<String>,
}

impl ExpressionError {
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        ExpressionError { span, message: message.into(), help: None }
    }

    pub(super) fn with_help(self, help: impl Into<String>) -> Self {
        ExpressionError { help: Some(help.into()), ..self }
    }
}

/// Letters of a quotation, beyond which it no longer reads as a name.
const QUOTED: usize = 40;

/// A piece of the text in backticks, cut if it is long.
pub(super) fn quoted(piece: &str) -> String {
    match piece.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("`{}…`", &piece[..end]),
        None => format!("`{piece}`"),
    }
}
