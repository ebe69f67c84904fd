//! The functions of the language, and how each becomes scalar instructions.

use super::error::ExpressionError;
use super::lower::{Argument, Lowering, Value, refused};
use super::operation::Operation::{self, *};
use super::tape::{Builder, Refusal, Slot};
use crate::space::Dimension;
use std::ops::Range;

/// A function, as messages show it.
pub(super) struct Function {
    pub(super) name: &'static str,
    /// A call of it, as a user writes one.
    pub(super) usage: &'static str,
    /// Fewest and most arguments.
    arguments: (usize, usize),
    does: Does,
}

/// The use that a function makes of its arguments.
#[derive(Clone, Copy)]
enum Does {
    /// Number → number.
    One(Operation),
    /// Two or more numbers → number, from the left.
    Fold(Operation),
    Dot,
    Distance,
    Length,
    Cross,
    Area,
    Volume,
}

const ANY: usize = usize::MAX;

#[rustfmt::skip]
pub(super) const FUNCTIONS: [Function; 19] = [
    Function { name: "sqrt", usage: "sqrt(a)", arguments: (1, 1), does: Does::One(SquareRoot) },
    Function { name: "sin", usage: "sin(a)", arguments: (1, 1), does: Does::One(Sine) },
    Function { name: "cos", usage: "cos(a)", arguments: (1, 1), does: Does::One(Cosine) },
    Function { name: "tan", usage: "tan(a)", arguments: (1, 1), does: Does::One(Tangent) },
    Function { name: "asin", usage: "asin(a)", arguments: (1, 1), does: Does::One(ArcSine) },
    Function { name: "acos", usage: "acos(a)", arguments: (1, 1), does: Does::One(ArcCosine) },
    Function { name: "atan", usage: "atan(a)", arguments: (1, 1), does: Does::One(ArcTangent) },
    Function { name: "atan2", usage: "atan2(y, x)", arguments: (2, 2), does: Does::Fold(Angle) },
    Function { name: "exp", usage: "exp(a)", arguments: (1, 1), does: Does::One(Exponential) },
    Function { name: "ln", usage: "ln(a)", arguments: (1, 1), does: Does::One(Logarithm) },
    Function { name: "abs", usage: "abs(a)", arguments: (1, 1), does: Does::One(Absolute) },
    Function { name: "min", usage: "min(a, b, …)", arguments: (2, ANY), does: Does::Fold(Least) },
    Function { name: "max", usage: "max(a, b, …)", arguments: (2, ANY), does: Does::Fold(Greatest) },
    Function { name: "dot", usage: "dot(a, b)", arguments: (2, 2), does: Does::Dot },
    Function { name: "dist", usage: "dist(a, b)", arguments: (2, 2), does: Does::Distance },
    Function { name: "length", usage: "length(a)", arguments: (1, 1), does: Does::Length },
    Function { name: "cross", usage: "cross(a, b)", arguments: (2, 2), does: Does::Cross },
    Function { name: "area", usage: "area(a, b, c, …)", arguments: (3, ANY), does: Does::Area },
    Function { name: "volume", usage: "volume(a, b, c, d)", arguments: (4, 4), does: Does::Volume },
];

/// The function of a name. `log` is another name of `ln`, as most languages write it.
pub(super) fn function(name: &str) -> Option<&'static Function> {
    static KNOWN: [Function; 19] = FUNCTIONS;
    let name = if name == "log" { "ln" } else { name };
    KNOWN.iter().find(|function| function.name == name)
}

impl Function {
    /// The number of arguments that it takes, in words.
    fn takes(&self) -> String {
        let (fewest, most) = self.arguments;
        let more = if most == ANY { " or more" } else { "" };
        format!("{fewest}{more} argument{}", if fewest == 1 && most == 1 { "" } else { "s" })
    }

    /// Lowers a call of this function; `span` is all of the call.
    pub(super) fn call(
        &self,
        lowering: &mut Lowering<'_>,
        span: &Range<usize>,
        arguments: &[Argument],
    ) -> Result<Value, ExpressionError> {
        let (fewest, most) = self.arguments;
        if !(fewest..=most).contains(&arguments.len()) {
            let message = format!(
                "`{}` takes {}, but {} {} given",
                self.name,
                self.takes(),
                arguments.len(),
                if arguments.len() == 1 { "is" } else { "are" }
            );
            return Err(ExpressionError::new(span.clone(), message).with_help(format!("write `{}`", self.usage)));
        }
        self.check_dimension(lowering, span)?;
        let at = |refusal| refused(refusal, span);
        match self.does {
            Does::One(operation) => {
                let a = self.number(lowering, &arguments[0])?;
                lowering.tape.unary(operation, a).map(Value::Number).map_err(at)
            }
            Does::Fold(operation) => {
                let mut result = self.number(lowering, &arguments[0])?;
                for argument in &arguments[1..] {
                    let next = self.number(lowering, argument)?;
                    result = lowering.tape.binary(operation, result, next).map_err(at)?;
                }
                Ok(Value::Number(result))
            }
            _ => {
                let points: Vec<Vec<Slot>> =
                    arguments.iter().map(|argument| self.point(lowering, argument)).collect::<Result<_, _>>()?;
                self.of_points(lowering, &points).map_err(at)
            }
        }
    }

    fn of_points(&self, lowering: &mut Lowering<'_>, points: &[Vec<Slot>]) -> Result<Value, Refusal> {
        let tape = &mut lowering.tape;
        match (self.does, points) {
            (Does::Dot, [a, b]) => dot(tape, a, b),
            (Does::Distance, [a, b]) => {
                let d = minus(tape, a, b)?;
                length(tape, &d)
            }
            (Does::Length, [a]) => length(tape, a),
            (Does::Cross, [a, b]) if a.len() == 2 => cross_of_two(tape, a, b),
            (Does::Cross, [a, b]) => return cross(tape, a, b).map(Value::Point),
            (Does::Volume, [a, b, c, d]) => {
                // (b − a) · ((c − a) × (d − a)) / 6
                let [b, c, d] = [minus(tape, b, a)?, minus(tape, c, a)?, minus(tape, d, a)?];
                let normal = cross(tape, &c, &d)?;
                let six = dot(tape, &b, &normal)?;
                let divisor = tape.constant(6.0)?;
                tape.binary(Divide, six, divisor)
            }
            // Σ p_i × p_{i+1} / 2, measured from the first corner: far from the origin the sum would lose digits.
            (_, corners) => {
                let origin = &corners[0];
                let arms =
                    corners[1..].iter().map(|corner| minus(tape, corner, origin)).collect::<Result<Vec<_>, _>>()?;
                let mut twice = cross_of_two(tape, &arms[0], &arms[1])?;
                for pair in arms[1..].windows(2) {
                    let next = cross_of_two(tape, &pair[0], &pair[1])?;
                    twice = tape.binary(Add, twice, next)?;
                }
                let half = tape.constant(0.5)?;
                tape.binary(Multiply, half, twice)
            }
        }
        .map(Value::Number)
    }

    fn check_dimension(&self, lowering: &Lowering<'_>, span: &Range<usize>) -> Result<(), ExpressionError> {
        match (self.does, lowering.scope.dimension) {
            (Does::Area, Dimension::Three) => {
                Err(ExpressionError::new(span.clone(), "`area` is signed, which has a meaning in two dimensions only")
                    .with_help("in three dimensions the area of a triangle is `length(cross(b - a, c - a))/2`"))
            }
            (Does::Volume, Dimension::Two) => {
                Err(ExpressionError::new(span.clone(), "`volume` needs three dimensions, and this system has two")
                    .with_help("the area of a polygon is `area(a, b, c)`"))
            }
            _ => Ok(()),
        }
    }

    fn number(&self, lowering: &Lowering<'_>, argument: &Argument) -> Result<Slot, ExpressionError> {
        match &argument.value {
            Value::Number(slot) => Ok(*slot),
            Value::Point(_) => {
                let piece = lowering.piece(&argument.span);
                let message = format!("{piece} is a point, but `{}` takes numbers", self.name);
                let help = if matches!(self.does, Does::One(Absolute)) {
                    "the length of a point is `length(a)`".into()
                } else {
                    lowering.number_from(&argument.span)
                };
                Err(ExpressionError::new(argument.span.clone(), message).with_help(help))
            }
        }
    }

    fn point(&self, lowering: &Lowering<'_>, argument: &Argument) -> Result<Vec<Slot>, ExpressionError> {
        match &argument.value {
            Value::Point(slots) => Ok(slots.clone()),
            Value::Number(_) => {
                let piece = lowering.piece(&argument.span);
                let message = format!("{piece} is a number, but `{}` takes points", self.name);
                let help = match self.does {
                    Does::Length => "the size of a number is `abs(a)`".into(),
                    _ => format!("a point is the name of a particle or `{}`", lowering.point_example()),
                };
                Err(ExpressionError::new(argument.span.clone(), message).with_help(help))
            }
        }
    }
}

/// a − b.
fn minus(tape: &mut Builder, a: &[Slot], b: &[Slot]) -> Result<Vec<Slot>, Refusal> {
    a.iter().zip(b).map(|(a, b)| tape.binary(Subtract, *a, *b)).collect()
}

/// a · b, summed from the first component on.
fn dot(tape: &mut Builder, a: &[Slot], b: &[Slot]) -> Result<Slot, Refusal> {
    let mut sum = tape.binary(Multiply, a[0], b[0])?;
    for (a, b) in a.iter().zip(b).skip(1) {
        let product = tape.binary(Multiply, *a, *b)?;
        sum = tape.binary(Add, sum, product)?;
    }
    Ok(sum)
}

/// |a|.
fn length(tape: &mut Builder, a: &[Slot]) -> Result<Slot, Refusal> {
    let square = dot(tape, a, a)?;
    tape.unary(SquareRoot, square)
}

/// a_i b_j − a_j b_i.
fn minor(tape: &mut Builder, a: &[Slot], b: &[Slot], i: usize, j: usize) -> Result<Slot, Refusal> {
    let left = tape.binary(Multiply, a[i], b[j])?;
    let right = tape.binary(Multiply, a[j], b[i])?;
    tape.binary(Subtract, left, right)
}

/// a × b in the plane.
fn cross_of_two(tape: &mut Builder, a: &[Slot], b: &[Slot]) -> Result<Slot, Refusal> {
    minor(tape, a, b, 0, 1)
}

/// a × b in space.
fn cross(tape: &mut Builder, a: &[Slot], b: &[Slot]) -> Result<Vec<Slot>, Refusal> {
    Ok(vec![minor(tape, a, b, 1, 2)?, minor(tape, a, b, 2, 0)?, minor(tape, a, b, 0, 1)?])
}
