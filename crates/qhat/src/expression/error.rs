//! Why an expression was refused: the place, the reason, and what to write instead.

use std::ops::Range;
use thiserror::Error;

/// Why an expression was refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct ExpressionError {
    /// The part of the text [bytes], on borders of characters; empty at the end of the text.
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

/// The longest quotation [letters]; a longer one no longer reads as a name.
const QUOTED: usize = 40;

/// A piece of the text in backticks, cut if it is long.
pub(super) fn quoted(piece: &str) -> String {
    match piece.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("`{}…`", &piece[..end]),
        None => format!("`{piece}`"),
    }
}
