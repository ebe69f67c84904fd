//! Names: time, a constant, a parameter, a particle, or one of the coordinates of a particle.

use super::MAX_NAMES;
use super::error::{ExpressionError, quoted};
use super::functions::function;
use super::lower::{Lowered, Lowering, Value, refused};
use super::scope::{CONSTANTS, Purpose};
use super::tape::Instruction;
use crate::space::{Dimension, ParticleId};
use std::ops::Range;

impl<'a> Lowering<'a> {
    /// Names of the language itself.
    fn own(&self) -> impl Iterator<Item = &'static str> {
        let variable = self.scope.purpose.variable();
        [variable, CONSTANTS[0].0, CONSTANTS[1].0].into_iter().filter(|name| !name.is_empty())
    }

    /// Whether a name without coordinate is known.
    pub(super) fn has_meaning(&self, name: &str) -> bool {
        self.own().any(|own| own == name)
            || (self.scope.particle)(name).is_some()
            || (self.scope.parameter)(name).is_some()
    }

    /// The value of the name at `span`.
    pub(super) fn name(&mut self, span: &Range<usize>) -> Lowered<Value> {
        let text = self.text;
        let word = &text[span.clone()];
        let (base, member) = match word.split_once('.') {
            Some((base, member)) => (base, Some(member)),
            None => (word, None),
        };
        if member.is_none() {
            if word == self.scope.purpose.variable() {
                return self.push(Instruction::Time, span).map(Value::Number);
            }
            if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == word) {
                return self.number(*value, span);
            }
        }
        self.names.insert(base);
        if self.names.len() > MAX_NAMES {
            let message = format!("the expression uses more than {MAX_NAMES} different names");
            return Err(
                ExpressionError::new(span.clone(), message).with_help("split it into several constraints or forces")
            );
        }
        match ((self.scope.particle)(base), (self.scope.parameter)(base), member) {
            (None, None, _) => Err(self.unknown(base, member, span)),
            (Some(_), Some(_), None) => {
                let message = format!("{} is both a particle and a parameter", quoted(base));
                Err(ExpressionError::new(span.clone(), message).with_help("give the parameter another name"))
            }
            (None, Some(value), None) => self.number(value, span),
            (None, Some(_), Some(member)) => Err(self.parameter_with_member(base, member, span)),
            (Some(place), _, None) if self.scope.purpose == Purpose::Parameters => {
                self.push(Instruction::Position(place.0), span).map(Value::Number)
            }
            (Some(_), _, Some(member)) if self.scope.purpose == Purpose::Parameters => {
                Err(self.parameter_with_member(base, member, span))
            }
            (Some(_), _, _) if self.scope.purpose == Purpose::Curve => {
                let message = format!("{} is a particle, but a curve depends on its parameter alone", quoted(base));
                Err(ExpressionError::new(span.clone(), message).with_help("use `s`, parameters and numbers"))
            }
            (Some(_), _, _) if self.scope.purpose == Purpose::Time => {
                let message = format!("{} is a particle, but this number may depend on time alone", quoted(base));
                Err(ExpressionError::new(span.clone(), message).with_help("use `t`, parameters and numbers"))
            }
            (Some(particle), _, None) => {
                let d = self.scope.dimension.number();
                let component = |k| self.push(Instruction::Position(particle.0 * d + k), span);
                (0..d).map(component).collect::<Lowered<_>>().map(Value::Point)
            }
            (Some(particle), _, Some(member)) => self.coordinate(particle, base, member, span),
        }
    }

    fn parameter_with_member(&self, base: &str, member: &str, span: &Range<usize>) -> ExpressionError {
        let message = format!("{} is a parameter, a number: it has no `.{}`", quoted(base), cut(member));
        ExpressionError::new(span.clone(), message).with_help(format!("write {}", quoted(base)))
    }

    fn number(&mut self, value: f64, span: &Range<usize>) -> Lowered<Value> {
        self.tape.constant(value).map(Value::Number).map_err(|why| refused(why, span))
    }

    /// bob.x or bob.vx.
    fn coordinate(&mut self, particle: ParticleId, base: &str, member: &str, span: &Range<usize>) -> Lowered<Value> {
        let (moves, axis) = match member.strip_prefix('v') {
            Some(axis) => (true, axis),
            None => (false, member),
        };
        let d = self.scope.dimension.number();
        let error = |message: String| ExpressionError::new(span.clone(), message);
        let Some(k) = ["x", "y", "z"].iter().position(|known| *known == axis) else {
            return Err(error(format!("a particle has no `.{}`", cut(member))).with_help(self.coordinates(base)));
        };
        if k >= d {
            let message = format!("there is no `.{member}` in two dimensions");
            return Err(error(message).with_help(self.coordinates(base)));
        }
        if !moves {
            return self.push(Instruction::Position(particle.0 * d + k), span).map(Value::Number);
        }
        let name = quoted(&self.text[span.clone()]);
        match self.scope.purpose {
            Purpose::Force => self.push(Instruction::Velocity(particle.0 * d + k), span).map(Value::Number),
            Purpose::Constraint => Err(error(format!(
                "{name} is a velocity, but a constraint C(q, t) = 0 may hold positions and time only: \
                 the velocities it allows follow from it"
            ))
            .with_help("write what the positions must satisfy; to act on velocities, use a force")),
            // Scopes of time, of a curve and of parameters have refused the coordinate.
            Purpose::Potential | Purpose::Time | Purpose::Curve | Purpose::Parameters => {
                Err(error(format!("{name} is a velocity, but a potential energy depends on positions and time only"))
                    .with_help(
                        "write a force that depends on velocities as a force, one expression for each component",
                    ))
            }
        }
    }

    /// Help on what may follow the name of a particle.
    fn coordinates(&self, base: &str) -> String {
        let axes: &[&str] = match self.scope.dimension {
            Dimension::Two => &["x", "y"],
            Dimension::Three => &["x", "y", "z"],
        };
        let moving = self.scope.purpose == Purpose::Force;
        let velocities = axes.iter().filter(|_| moving).map(|axis| format!("v{axis}"));
        let all: Vec<String> = axes.iter().map(|axis| (*axis).to_string()).chain(velocities).collect();
        let written: Vec<String> = all.iter().map(|axis| format!("`{}.{axis}`", cut(base))).collect();
        let (last, others) = written.split_last().expect("every particle has coordinates");
        format!("write {} or {last}", others.join(", "))
    }

    fn unknown(&self, base: &str, member: Option<&str>, span: &Range<usize>) -> ExpressionError {
        let what = if member.is_some() { "particle" } else { "name" };
        let error =
            ExpressionError::new(span.start..span.start + base.len(), format!("there is no {what} {}", quoted(base)));
        if let Some(function) = function(base) {
            let message = format!("`{base}` is a function: its arguments are missing");
            return ExpressionError { message, ..error }.with_help(format!("write `{}`", function.usage));
        }
        if self.scope.purpose == Purpose::Parameters && base == "t" {
            let message = "`t` is time, and this number is the same at all times".to_owned();
            return ExpressionError { message, ..error }.with_help("use parameters, `pi` and `tau`");
        }
        match (self.scope.suggest)(base, &self.own().collect::<Vec<_>>()) {
            Some(near) => error.with_help(format!("did you mean `{near}`?")),
            None => error.with_help(match self.scope.purpose {
                Purpose::Time => "names are `t`, parameters, `pi` and `tau`",
                Purpose::Curve => "names are `s` along the curve, parameters, `pi` and `tau`",
                Purpose::Parameters => "names are the parameters of the scene, `pi` and `tau`",
                _ => "names are particles, parameters, `t`, `pi` and `tau`",
            }),
        }
    }
}

/// A word short enough to show.
fn cut(word: &str) -> String {
    quoted(word).trim_matches('`').to_string()
}
