//! Syntax: tokens → tree, by operator precedence:
//!
//! ```text
//! a ^ b        binds tightest, to the right
//! −a
//! a * b, a / b to the left
//! a + b, a − b to the left
//! ```
//!
//! Parsing recurses once for each bracket, sign and power, and at most twice more a bracket, for a factor of a
//! summand. The depth is counted over the tokens before parsing begins.

use super::error::{ExpressionError, quoted};
use super::token::{Token, TokenKind};
use super::{MAX_DEPTH, MAX_NODES};
use std::ops::Range;
use winnow::combinator::{Infix, Prefix, cut_err, expression};
use winnow::error::{ErrMode, ParserError};
use winnow::prelude::*;
use winnow::stream::{Stateful, Stream};

/// The place of a node in the tree. Operands stand before their operation.
pub(super) type Node = usize;

/// A node of the tree.
#[derive(Clone, Debug)]
pub(super) enum Syntax {
    Number(f64),
    /// A name, by its span without the brackets around it.
    Name(Range<usize>),
    Negative(Node),
    Binary(Operator, Node, Node),
    /// A function, by the span of its name, and its arguments.
    Call(Range<usize>, Vec<Node>),
    /// [1, 2]
    Point(Vec<Node>),
}

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
    ToThe,
}

/// All nodes with their spans; the last is the root.
#[derive(Debug, Default)]
pub(super) struct Tree {
    pub(super) nodes: Vec<(Syntax, Range<usize>)>,
    /// The places of the signs whose operands are not yet read.
    signs: Vec<usize>,
}

type Input<'i> = Stateful<&'i [Token], Tree>;
type Parsed<O> = Result<O, ErrMode<Fault>>;

/// The reason for which parsing stopped.
#[derive(Clone, Debug)]
enum Fault {
    /// No operand begins where so many tokens remain.
    NoOperand(usize),
    /// A bracket opened at this token is not closed where so many tokens remain.
    NotClosed(Range<usize>, usize),
    TooMany(Range<usize>),
}

impl<'i> ParserError<Input<'i>> for Fault {
    type Inner = Self;

    fn from_input(input: &Input<'i>) -> Self {
        Fault::NoOperand(input.eof_offset())
    }

    fn into_inner(self) -> Result<Self, Self> {
        Ok(self)
    }
}

/// The tree of a text.
pub(super) fn tree(text: &str, tokens: &[Token]) -> Result<Tree, ExpressionError> {
    check_depth(tokens)?;
    let mut input = Stateful { input: tokens, state: Tree::default() };
    let fault = match whole(&mut input) {
        Ok(_) if input.input.is_empty() => return Ok(input.state),
        Ok(_) => return Err(left_over(text, tokens, input.input)),
        Err(fault) => fault.into_inner().unwrap_or(Fault::NoOperand(0)),
    };
    Err(match fault {
        Fault::NoOperand(rest) => no_operand(text, tokens, rest),
        Fault::NotClosed(open, rest) => not_closed(text, tokens, open, rest),
        Fault::TooMany(span) => ExpressionError::new(
            span,
            format!("the expression has more than {MAX_NODES} numbers, names and operations"),
        )
        .with_help("split it into several constraints or forces"),
    })
}

/// The largest number of brackets, signs and powers that are open at once.
fn check_depth(tokens: &[Token]) -> Result<(), ExpressionError> {
    // Signs and powers of each open bracket; the end of a summand or factor closes those it contains.
    let mut open = vec![0];
    let mut depth = 0;
    let mut after_operand = false;
    for token in tokens {
        let top = open.len() - 1;
        let mut opens = true;
        match token.kind {
            TokenKind::Symbol('(' | '[') => open.push(0),
            TokenKind::Symbol('^') => open[top] += 1,
            TokenKind::Symbol('-') if !after_operand => open[top] += 1,
            TokenKind::Symbol(')' | ']') if top > 0 => {
                depth -= 1 + open[top];
                open.pop();
                opens = false;
            }
            TokenKind::Symbol('+' | '-' | '*' | '/' | ',') => {
                depth -= open[top];
                open[top] = 0;
                opens = false;
            }
            _ => opens = false,
        }
        after_operand = matches!(token.kind, TokenKind::Number(_) | TokenKind::Name | TokenKind::Symbol(')' | ']'));
        depth += usize::from(opens);
        if depth > MAX_DEPTH {
            let message = format!("brackets, signs and powers are nested more than {MAX_DEPTH} deep");
            return Err(ExpressionError::new(token.span.clone(), message));
        }
    }
    Ok(())
}

fn whole(input: &mut Input<'_>) -> Parsed<Node> {
    expression(operand).prefix(sign).infix(operator).parse_next(input)
}

/// A number, a name, a call, a bracket or a point.
fn operand(input: &mut Input<'_>) -> Parsed<Node> {
    let Some(token) = input.input.first() else { return Err(ErrMode::Backtrack(Fault::from_input(input))) };
    let called = matches!(input.input.get(1), Some(Token { kind: TokenKind::Symbol('('), .. }));
    match token.kind {
        TokenKind::Number(value) => {
            input.next_token();
            push(input, Syntax::Number(value), token.span.clone())
        }
        TokenKind::Name if called => {
            input.next_token();
            let (arguments, end) = cut_err(listed(')')).parse_next(input)?;
            push(input, Syntax::Call(token.span.clone(), arguments), token.span.start..end)
        }
        TokenKind::Name => {
            input.next_token();
            push(input, Syntax::Name(token.span.clone()), token.span.clone())
        }
        TokenKind::Symbol('(') => {
            input.next_token();
            let node = cut_err(whole).parse_next(input)?;
            let end = close(input, ')', &token.span)?;
            // The span of an operation on a bracket includes the bracket.
            input.state.nodes[node].1 = token.span.start..end;
            Ok(node)
        }
        TokenKind::Symbol('[') => {
            let (components, end) = cut_err(listed(']')).parse_next(input)?;
            push(input, Syntax::Point(components), token.span.start..end)
        }
        TokenKind::Symbol(_) => Err(ErrMode::Backtrack(Fault::from_input(input))),
    }
}

/// The expressions between two brackets, at the opening one; and where the closing one ends.
fn listed<'i>(closing: char) -> impl FnMut(&mut Input<'i>) -> Parsed<(Vec<Node>, usize)> {
    move |input| {
        let open = input.input[0].span.clone();
        input.next_token();
        let mut nodes = Vec::new();
        if !next_is(input, closing) {
            nodes.push(whole(input)?);
            while next_is(input, ',') {
                input.next_token();
                nodes.push(whole(input)?);
            }
        }
        Ok((nodes, close(input, closing, &open)?))
    }
}

fn close(input: &mut Input<'_>, closing: char, open: &Range<usize>) -> Parsed<usize> {
    if !next_is(input, closing) {
        return Err(ErrMode::Cut(Fault::NotClosed(open.clone(), input.input.len())));
    }
    let end = input.input[0].span.end;
    input.next_token();
    Ok(end)
}

fn next_is(input: &Input<'_>, symbol: char) -> bool {
    input.input.first().is_some_and(|token| token.kind == TokenKind::Symbol(symbol))
}

fn sign<'i>(input: &mut Input<'i>) -> Parsed<Prefix<Input<'i>, Node, ErrMode<Fault>>> {
    if !next_is(input, '-') {
        return Err(ErrMode::Backtrack(Fault::from_input(input)));
    }
    let start = input.input[0].span.start;
    input.state.signs.push(start);
    input.next_token();
    Ok(Prefix(3, |input, of| {
        let end = input.state.nodes[of].1.end;
        let start = input.state.signs.pop().unwrap_or(end);
        push(input, Syntax::Negative(of), start..end)
    }))
}

fn operator<'i>(input: &mut Input<'i>) -> Parsed<Infix<Input<'i>, Node, ErrMode<Fault>>> {
    let infix = match input.input.first().map(|token| token.kind) {
        Some(TokenKind::Symbol('+')) => Infix::Left(1, |input, a, b| binary(input, Operator::Plus, a, b)),
        Some(TokenKind::Symbol('-')) => Infix::Left(1, |input, a, b| binary(input, Operator::Minus, a, b)),
        Some(TokenKind::Symbol('*')) => Infix::Left(2, |input, a, b| binary(input, Operator::Times, a, b)),
        Some(TokenKind::Symbol('/')) => Infix::Left(2, |input, a, b| binary(input, Operator::Over, a, b)),
        Some(TokenKind::Symbol('^')) => Infix::Right(5, |input, a, b| binary(input, Operator::ToThe, a, b)),
        _ => return Err(ErrMode::Backtrack(Fault::from_input(input))),
    };
    input.next_token();
    Ok(infix)
}

fn binary(input: &mut Input<'_>, operator: Operator, a: Node, b: Node) -> Parsed<Node> {
    let nodes = &input.state.nodes;
    let span = nodes[a].1.start..nodes[b].1.end;
    push(input, Syntax::Binary(operator, a, b), span)
}

fn push(input: &mut Input<'_>, syntax: Syntax, span: Range<usize>) -> Parsed<Node> {
    let nodes = &mut input.state.nodes;
    if nodes.len() == MAX_NODES {
        return Err(ErrMode::Cut(Fault::TooMany(span)));
    }
    nodes.push((syntax, span));
    Ok(nodes.len() - 1)
}

fn no_operand(text: &str, tokens: &[Token], rest: usize) -> ExpressionError {
    let at = tokens.len() - rest;
    let before = at.checked_sub(1).map(|before| &tokens[before]);
    let Some(token) = tokens.get(at) else {
        return match before {
            None => ExpressionError::new(0..text.len(), "the expression is empty").with_help("write `0` for nothing"),
            Some(before) => {
                let message = format!("the expression ends after {}", quoted(&text[before.span.clone()]));
                ExpressionError::new(before.span.clone(), message)
                    .with_help("a number, a name or a bracket must follow")
            }
        };
    };
    let found = quoted(&text[token.span.clone()]);
    let message = match before {
        None => format!("an expression cannot begin with {found}"),
        Some(before) => format!("{found} cannot follow {}", quoted(&text[before.span.clone()])),
    };
    let error = ExpressionError::new(token.span.clone(), message);
    match (before.map(|before| before.kind), token.kind) {
        (Some(TokenKind::Symbol('*')), TokenKind::Symbol('*')) => error.with_help("write a power as `a^b`"),
        (_, TokenKind::Symbol('+')) => error.with_help("leave the `+` out"),
        _ => error.with_help("a number, a name or a bracket must stand here"),
    }
}

fn not_closed(text: &str, tokens: &[Token], open: Range<usize>, rest: usize) -> ExpressionError {
    let bracket = &text[open.clone()];
    let closing = if bracket == "[" { "]" } else { ")" };
    match &tokens[tokens.len() - rest..] {
        [] => ExpressionError::new(open, format!("this `{bracket}` is never closed"))
            .with_help(format!("add a `{closing}`")),
        [token, ..] if token.kind == TokenKind::Symbol(',') => ExpressionError::new(
            token.span.clone(),
            "a comma separates the arguments of a function or the components of a point",
        )
        .with_help("write a number with a point, `1.5`, and a point in square brackets, `[1, 2]`"),
        rest => left_over(text, tokens, rest),
    }
}

/// The error of text that follows a complete expression.
fn left_over(text: &str, tokens: &[Token], rest: &[Token]) -> ExpressionError {
    let token = &rest[0];
    let found = quoted(&text[token.span.clone()]);
    let span = token.span.clone();
    match token.kind {
        TokenKind::Symbol(closing @ (')' | ']')) => {
            let message = format!("this `{closing}` closes nothing that was opened before it");
            ExpressionError::new(span, message)
                .with_help(format!("leave it out, or open it with a `{}`", if closing == ')' { '(' } else { '[' }))
        }
        TokenKind::Symbol(',') => {
            ExpressionError::new(span, "a comma separates the arguments of a function or the components of a point")
                .with_help("write a number with a point, `1.5`; several expressions are several texts")
        }
        _ => {
            let before = quoted(&text[tokens[tokens.len() - rest.len() - 1].span.clone()]);
            ExpressionError::new(span, format!("an operator is missing between {before} and {found}"))
                .with_help("write a product with `*`")
        }
    }
}
