//! Lower: tree → tape. Names get their meaning and points become d scalars. A part without a meaning is refused with
//! its place.

use super::error::{ExpressionError, quoted};
use super::functions::{FUNCTIONS, function};
use super::operation::Operation;
use super::scope::Scope;
use super::syntax::{Operator, Syntax, Tree};
use super::tape::{Builder, Instruction, Refusal, Slot, Tape};
use super::{MAX_INSTRUCTIONS, MAX_PRODUCT};
use std::collections::BTreeSet;
use std::ops::Range;

/// A part of the expression on the tape.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Number(Slot),
    /// d components.
    Point(Vec<Slot>),
}

/// A value and the place of its text.
pub(super) struct Argument {
    pub(super) value: Value,
    pub(super) span: Range<usize>,
}

pub(super) struct Lowering<'a> {
    pub(super) text: &'a str,
    pub(super) scope: &'a Scope<'a>,
    pub(super) tape: Builder,
    /// The different names so far.
    pub(super) names: BTreeSet<&'a str>,
}

pub(super) type Lowered<T> = Result<T, ExpressionError>;

/// The tape of a tree.
pub(super) fn tape(text: &str, tree: Tree, scope: &Scope<'_>) -> Lowered<Tape> {
    let mut lowering = Lowering { text, scope, tape: Builder::default(), names: BTreeSet::new() };
    let mut values: Vec<Value> = Vec::with_capacity(tree.nodes.len());
    for (syntax, span) in &tree.nodes {
        let of = |node: usize| Argument { value: values[node].clone(), span: tree.nodes[node].1.clone() };
        let value = match syntax {
            Syntax::Number(value) => Value::Number(lowering.tape.constant(*value).map_err(|why| refused(why, span))?),
            Syntax::Name(word) => lowering.name(word)?,
            Syntax::Negative(a) => lowering.each(Operation::Negate, &values[*a], span)?,
            Syntax::Binary(operator, a, b) => lowering.binary(*operator, of(*a), of(*b), span)?,
            Syntax::Call(name, arguments) => {
                let arguments: Vec<Argument> = arguments.iter().map(|node| of(*node)).collect();
                lowering.call(name, span, &arguments)?
            }
            Syntax::Point(components) => {
                let components: Vec<Argument> = components.iter().map(|node| of(*node)).collect();
                lowering.point(span, &components)?
            }
        };
        values.push(value);
    }
    match (values.last(), tree.nodes.last()) {
        (Some(Value::Number(root)), _) => Ok(lowering.tape.finish(*root, scope.dimension.number())),
        (Some(Value::Point(_)), Some((_, span))) => {
            Err(ExpressionError::new(span.clone(), "the expression is a point, but must be a number")
                .with_help(lowering.number_from(span)))
        }
        _ => Err(ExpressionError::new(0..text.len(), "the expression is empty")),
    }
}

/// The error of an instruction that could not be appended, at the part of the text that needs it.
pub(super) fn refused(refusal: Refusal, span: &Range<usize>) -> ExpressionError {
    match refusal {
        Refusal::TooMany => {
            let message = format!("the expression takes more than {MAX_INSTRUCTIONS} operations on numbers");
            ExpressionError::new(span.clone(), message).with_help("split it into several constraints or forces")
        }
        Refusal::NotFinite => ExpressionError::new(span.clone(), "this is never a finite number")
            .with_help("it divides by zero, leaves the domain of a function or is too large"),
    }
}

impl<'a> Lowering<'a> {
    /// A part of the text in backticks.
    pub(super) fn piece(&self, span: &Range<usize>) -> String {
        quoted(&self.text[span.clone()])
    }

    /// Help on how to make a number of the point at `span`.
    pub(super) fn number_from(&self, span: &Range<usize>) -> String {
        let piece = &self.text[span.clone()];
        if super::token::is_name(piece) && piece.len() <= 20 {
            format!("take a coordinate, `{piece}.x`, or a length, `length({piece})`")
        } else {
            "take a length, `length(a)`, or a product with another point, `dot(a, b)`".into()
        }
    }

    /// A point of the right dimension.
    pub(super) fn point_example(&self) -> &'static str {
        if self.scope.dimension.number() == 2 { "[1, 2]" } else { "[1, 2, 3]" }
    }

    pub(super) fn push(&mut self, instruction: Instruction, span: &Range<usize>) -> Lowered<Slot> {
        self.tape.push(instruction).map_err(|why| refused(why, span))
    }

    fn operate(&mut self, operation: Operation, a: Slot, b: Slot, span: &Range<usize>) -> Lowered<Slot> {
        self.tape.binary(operation, a, b).map_err(|why| refused(why, span))
    }

    /// A function of one number on a number or on each component of a point.
    fn each(&mut self, operation: Operation, a: &Value, span: &Range<usize>) -> Lowered<Value> {
        Ok(match a {
            Value::Number(a) => Value::Number(self.operate(operation, *a, *a, span)?),
            Value::Point(a) => {
                Value::Point(a.iter().map(|a| self.operate(operation, *a, *a, span)).collect::<Lowered<_>>()?)
            }
        })
    }

    fn binary(&mut self, operator: Operator, a: Argument, b: Argument, span: &Range<usize>) -> Lowered<Value> {
        use Operator::*;
        use Value::{Number, Point};
        let operation = match operator {
            Plus => Operation::Add,
            Minus => Operation::Subtract,
            Times => Operation::Multiply,
            Over => Operation::Divide,
            ToThe => Operation::Power,
        };
        Ok(match (operator, &a.value, &b.value) {
            (ToThe, Number(x), Number(y)) => Number(self.power(*x, *y, span)?),
            (_, Number(x), Number(y)) => Number(self.operate(operation, *x, *y, span)?),
            (Plus | Minus, Point(x), Point(y)) => {
                Point(x.iter().zip(y).map(|(x, y)| self.operate(operation, *x, *y, span)).collect::<Lowered<_>>()?)
            }
            (Times, Number(s), Point(x)) => {
                Point(x.iter().map(|x| self.operate(operation, *s, *x, span)).collect::<Lowered<_>>()?)
            }
            (Times | Over, Point(x), Number(s)) => {
                Point(x.iter().map(|x| self.operate(operation, *x, *s, span)).collect::<Lowered<_>>()?)
            }
            _ => return Err(self.mismatch(operator, &a, &b, span)),
        })
    }

    /// The error of an operator between values of the wrong type.
    fn mismatch(&self, operator: Operator, a: &Argument, b: &Argument, span: &Range<usize>) -> ExpressionError {
        let kind = |value: &Value| if matches!(value, Value::Number(_)) { "a number" } else { "a point" };
        let (x, y) = (self.piece(&a.span), self.piece(&b.span));
        let (first, second) = (kind(&a.value), kind(&b.value));
        let both_points = first == second;
        let point = if first == "a point" { a } else { b };
        let (message, help) = match operator {
            Operator::Plus | Operator::Minus => {
                let verb = if operator == Operator::Plus { "added" } else { "subtracted" };
                (format!("{x} is {first} and {y} is {second}: they cannot be {verb}"), self.number_from(&point.span))
            }
            Operator::Times => (
                format!("{x} and {y} are points, which `*` does not multiply"),
                "write `dot(a, b)` for the dot product and `cross(a, b)` for the cross product".into(),
            ),
            Operator::Over => {
                (format!("{y} is a point, and nothing can be divided by a point"), self.number_from(&b.span))
            }
            Operator::ToThe if both_points || first == "a number" => {
                (format!("{y} is a point, and an exponent must be a number"), self.number_from(&b.span))
            }
            Operator::ToThe => {
                (format!("{x} is a point, and `^` takes numbers"), "the square of a length is `dot(a, a)`".into())
            }
        };
        ExpressionError::new(span.clone(), message).with_help(help)
    }

    /// x^y. A small integer y is a product, so that all derivatives are right at x = 0, too.
    fn power(&mut self, x: Slot, y: Slot, span: &Range<usize>) -> Lowered<Slot> {
        let Some(p) = self.tape.known(y) else { return self.operate(Operation::Power, x, y, span) };
        if p != p.trunc() || p.abs() > MAX_PRODUCT {
            return self.operate(Operation::PowerOf, x, y, span);
        }
        let mut product = None;
        let mut square = x;
        let mut n = p.abs() as u32;
        while n > 0 {
            if n % 2 == 1 {
                product = Some(match product {
                    None => square,
                    Some(product) => self.operate(Operation::Multiply, product, square, span)?,
                });
            }
            n /= 2;
            if n > 0 {
                square = self.operate(Operation::Multiply, square, square, span)?;
            }
        }
        let one = self.push(Instruction::Constant(1.0_f64.to_bits()), span)?;
        match product {
            None => Ok(one),
            Some(product) if p > 0.0 => Ok(product),
            Some(product) => self.operate(Operation::Divide, one, product, span),
        }
    }

    fn point(&mut self, span: &Range<usize>, components: &[Argument]) -> Lowered<Value> {
        let d = self.scope.dimension.number();
        if components.len() != d {
            let message = format!(
                "a point of this system has {d} numbers, but {} {} given",
                components.len(),
                if components.len() == 1 { "is" } else { "are" }
            );
            return Err(
                ExpressionError::new(span.clone(), message).with_help(format!("write `{}`", self.point_example()))
            );
        }
        let component = |argument: &Argument| match argument.value {
            Value::Number(slot) => Ok(slot),
            Value::Point(_) => {
                let message =
                    format!("{} is a point, but the components of a point are numbers", self.piece(&argument.span));
                Err(ExpressionError::new(argument.span.clone(), message).with_help(self.number_from(&argument.span)))
            }
        };
        components.iter().map(component).collect::<Lowered<_>>().map(Value::Point)
    }

    fn call(&mut self, name: &Range<usize>, span: &Range<usize>, arguments: &[Argument]) -> Lowered<Value> {
        let word = &self.text[name.clone()];
        if let Some(function) = function(word) {
            return function.call(self, span, arguments);
        }
        let error = ExpressionError::new(name.clone(), format!("there is no function {}", quoted(word)));
        Err(if word.contains('.') || self.has_meaning(word) {
            error.with_help("for a product write `*` before the bracket")
        } else if let Some(near) = (self.scope.suggest)(word, &FUNCTIONS.map(|function| function.name)) {
            error.with_help(format!("did you mean `{near}`?"))
        } else {
            error.with_help(format!("the functions are {}", FUNCTIONS.map(|function| function.name).join(", ")))
        })
    }
}
