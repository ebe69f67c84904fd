//! Token: text → tokens, each with its span.

use super::error::{ExpressionError, quoted};
use std::ops::Range;
use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, opt};
use winnow::error::EmptyError;
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location};
use winnow::token::{one_of, take_while};

/// The kind of a token. The text of a name is read from its span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    /// `a` or `a.x`.
    Name,
    /// An operator, a bracket or a comma.
    Symbol(char),
}

/// A token and its place in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Range<usize>,
}

type Text<'i> = LocatingSlice<&'i str>;
type Lexed<O> = Result<O, EmptyError>;

const SYMBOLS: [char; 10] = ['+', '-', '*', '/', '^', '(', ')', '[', ']', ','];

/// All tokens of a text.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, ExpressionError> {
    let mut tokens = Vec::new();
    let mut input = LocatingSlice::new(text);
    loop {
        let _: Lexed<&str> = take_while(0.., char::is_whitespace).parse_next(&mut input);
        let start = input.current_token_start();
        let Some(next) = text[start..].chars().next() else { return Ok(tokens) };
        let kind =
            alt((number, name.value(TokenKind::Name), one_of(SYMBOLS).map(TokenKind::Symbol))).parse_next(&mut input);
        let span = start..input.current_token_start();
        match kind {
            Ok(TokenKind::Number(value)) if !value.is_finite() => {
                return Err(ExpressionError::new(
                    span.clone(),
                    format!("{} is too large for a number", quoted(&text[span])),
                )
                .with_help("the largest number is about 1.8e308"));
            }
            Ok(kind) => tokens.push(Token { kind, span }),
            Err(_) => return Err(stray(start, next)),
        }
    }
}

/// Whether a whole text is one name without a dot.
pub(super) fn is_name(text: &str) -> bool {
    identifier.parse(LocatingSlice::new(text)).is_ok()
}

/// 2, 2.5, .5, 2.5e-3
fn number(input: &mut Text<'_>) -> Lexed<TokenKind> {
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    (mantissa, opt(exponent)).take().parse_to::<f64>().map(TokenKind::Number).parse_next(input)
}

/// bob, bob.x
fn name<'i>(input: &mut Text<'i>) -> Lexed<&'i str> {
    (identifier, opt(('.', identifier))).take().parse_next(input)
}

fn identifier<'i>(input: &mut Text<'i>) -> Lexed<&'i str> {
    let first = one_of(|c: char| c.is_alphabetic() || c == '_');
    (first, take_while(0.., |c: char| c.is_alphabetic() || c.is_ascii_digit() || c == '_')).take().parse_next(input)
}

/// The error of a character that begins no token.
fn stray(start: usize, c: char) -> ExpressionError {
    let shown = if c.is_control() { format!("the character U+{:04X}", c as u32) } else { format!("`{c}`") };
    let help = match c {
        '\u{2212}' | '\u{2013}' | '\u{2014}' => "write minus as `-`",
        '×' | '·' | '∙' | '⋅' => "write a product as `*`, and the dot product of two points as `dot(a, b)`",
        '÷' => "write a quotient as `/`",
        '²' => "write a square as `^2`",
        '³' => "write a cube as `^3`",
        '=' => "an expression is one side only: to hold a = b, write `a - b`",
        '<' | '>' => "only equalities can be held: write what shall be zero",
        '|' => "write |a| as `abs(a)` for a number and as `length(a)` for a point",
        '{' | '}' => "use round brackets, `(a + b)`",
        '.' => "a coordinate is written without spaces, `bob.x`",
        ';' => "separate arguments by `,`",
        _ => "an expression holds numbers, names, `+ - * / ^`, brackets and commas",
    };
    ExpressionError::new(start..start + c.len_utf8(), format!("{shown} has no meaning in an expression"))
        .with_help(help)
}
