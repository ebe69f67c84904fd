//! The error of an expression that is refused: the place, the reason and the remedy.

use std::ops::Range;
use thiserror::Error;

/// The error of an expression that is refused.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{message}")]
pub struct ExpressionError {
    /// The part of the text \[bytes\], on borders of characters; empty at the end of the text.
    pub span: Range<usize>,
    /// The mistake, as a sentence.
    pub message: String,
    /// The remedy, if it is known.
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

/// The reason for which a parameter of expressions is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParameterError {
    /// The name is no word.
    #[error("`{name}` is not a name: a name begins with a letter or `_` and goes on with letters, digits or `_`")]
    NotAName {
        /// The name.
        name: String,
    },
    /// The name stands for time or a constant.
    #[error("`{name}` already has a meaning in expressions: give the parameter another name")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// The name stands for a function.
    #[error("`{name}` is a function: give the parameter another name")]
    Function {
        /// The name.
        name: String,
    },
    /// The number is infinite or not a number.
    #[error("the parameter `{name}` must be a finite number, but is {value}")]
    NotFinite {
        /// The name.
        name: String,
        /// The number.
        value: f64,
    },
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
