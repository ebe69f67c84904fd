//! Constraints, forces and potentials written as expressions. Their errors point into the text of the scene.

use super::Assembly;
use super::uses::key_span;
use crate::model::Parameters;
use crate::model::expression::{self as model, Residual};
use crate::report::Report;
use crate::suggest::nearest;
use crate::tree::Node;
use qhat::expression::check_parameter;
use qhat::{Expression, Purpose, Scope, State};
use std::ops::Range;

/// A force or potential whose value at the start has yet to be checked, and its place in the text.
pub(super) struct Untried {
    expression: Expression,
    place: Range<usize>,
}

impl Untried {
    pub(super) fn try_at(&self, state: &State, report: &mut Report<'_>) {
        let Untried { expression, place } = self;
        let mut slopes = vec![0.0; 2 * expression.gradient_len()];
        let (by_position, by_velocity) = slopes.split_at_mut(expression.gradient_len());
        let value = expression.gradient(state.positions(), state.velocities(), 0.0, by_position, by_velocity);
        if !value.is_finite() || slopes.iter().any(|slope| !slope.is_finite()) {
            let message = "this expression or a derivative of it is not a finite number at the start";
            let help = "the expression must have a value at t = 0 and the positions at the start";
            report.error(place.clone(), message, Some(help.into()));
        }
    }
}

impl Assembly<'_, '_, '_> {
    pub(super) fn add_expression(&mut self, given: &model::Expression, place: &Node) -> Option<()> {
        self.check_parameters(&given.parameters, place)?;
        let (texts, is_list) = match &given.residual {
            Residual::One(text) => (std::slice::from_ref(text), false),
            Residual::Several(texts) => (&texts[..], true),
        };
        let name = self.name_of(given);
        let place = place.key("residual");
        for (k, text) in texts.iter().enumerate() {
            let place = place.item(k);
            let expression = self.expression(text, Purpose::Constraint, &given.parameters, place)?;
            let constraint = qhat::ExpressionConstraint::new(expression, self.start_positions());
            let constraint = match given.scale {
                Some(scale) => constraint.with_scale(scale),
                None => constraint,
            };
            if let Err(reason) = constraint.check() {
                // The scale is above 0, as the schema asks, so that one of these three is wrong.
                let help = if constraint.expression().particles().is_empty() {
                    "write it in the coordinates of particles"
                } else if given.scale.is_none() && constraint.with_scale(1.0).check().is_ok() {
                    "add `scale`, the size of the residual that counts as a relative error of 1"
                } else {
                    "C(q, t) and its derivatives must be finite numbers at t = 0 and the positions at the start"
                };
                self.report.error(place.span.clone(), reason.to_string(), Some(help.into()));
                return None;
            }
            let row = if is_list { format!("{name}[{k}]") } else { name.clone() };
            self.builder.constraint(row, constraint);
        }
        Some(())
    }

    pub(super) fn add_expression_force(&mut self, given: &model::Force, place: &Node) -> Option<()> {
        let particle = self.particle(&given.particle, place.key("particle"))?;
        self.check_parameters(&given.parameters, place)?;
        let mut components = Vec::new();
        for (k, text) in given.force.iter().enumerate() {
            let place = place.key("force").item(k);
            let component = self.expression(text, Purpose::Force, &given.parameters, place)?;
            self.untried.push(Untried { expression: component.clone(), place: place.span.clone() });
            components.push(component);
        }
        self.builder.force(qhat::ExpressionForce { particle, components });
        Some(())
    }

    pub(super) fn add_expression_potential(&mut self, given: &model::Potential, place: &Node) -> Option<()> {
        self.check_parameters(&given.parameters, place)?;
        let place = place.key("potential");
        let potential = self.expression(&given.potential, Purpose::Potential, &given.parameters, place)?;
        if potential.particles().is_empty() {
            let message = "the potential depends on no particle and exerts no force";
            self.report.error(place.span.clone(), message, Some("write it in the coordinates of particles".into()));
            return None;
        }
        self.untried.push(Untried { expression: potential.clone(), place: place.span.clone() });
        self.builder.force(qhat::ExpressionPotential { potential });
        Some(())
    }

    /// The expression of a text whose value stands at `place`.
    pub(super) fn expression(
        &mut self,
        text: &str,
        purpose: Purpose,
        parameters: &Parameters,
        place: &Node,
    ) -> Option<Expression> {
        let (ids, scene, used, start) = (&self.ids, &self.parameters, &self.made.in_expressions, place.span.start);
        let suggest = |name: &str, own: &[&'static str]| {
            let names = parameters.keys().chain(scene.keys()).map(String::as_str).chain(own.iter().copied());
            nearest(name, names.chain(ids.alike(name))).map(str::to_owned)
        };
        let scope = Scope {
            purpose,
            dimension: self.dimension_of_system(),
            particle: &|name| ids.find(name),
            parameter: &|name| {
                parameters.get(name).copied().or_else(|| {
                    let value = scene.get(name).copied()?;
                    used.borrow_mut().insert((name.to_owned(), start));
                    Some(value)
                })
            },
            suggest: &suggest,
        };
        let error = match Expression::parse(text, &scope) {
            Ok(expression) => return Some(expression),
            Err(error) => error,
        };
        let span = self.report.piece(&place.span, text, &error.span);
        let help = match self.ids.without_name(text) {
            Some(id) => Some(format!(
                "{} cannot be named in expressions, where names are made of letters, `_` and the digits 0 to 9",
                self.report.quoted(id)
            )),
            None => error.help.map(|help| self.report.fitted(&help)),
        };
        self.report.error(span, self.report.fitted(&error.message), help);
        None
    }

    /// `None` after reporting a parameter beside an expression that cannot be one.
    fn check_parameters(&mut self, parameters: &Parameters, place: &Node) -> Option<()> {
        let mut is_clean = true;
        for (name, &value) in parameters {
            let is_taken = || {
                let message = format!("{} is a parameter of the whole scene already", self.report.quoted(name));
                let help = "leave it out here, or give it another name";
                self.parameters.contains_key(name).then(|| (message, Some(help.to_owned())))
            };
            if let Some(wrong) = self.wrong_parameter(name, value).or_else(is_taken) {
                self.refuse_parameter(place.key("parameters"), name, wrong);
                is_clean = false;
            }
        }
        is_clean.then_some(())
    }

    /// The reason why this cannot be a parameter, and the help.
    pub(super) fn wrong_parameter(&self, name: &str, value: f64) -> Option<(String, Option<String>)> {
        match check_parameter(name, value) {
            Err(reason) => Some((reason.to_string(), None)),
            Ok(()) => self.ids.find(name).map(|_| {
                let message = format!("{} is the id of a particle, too", self.report.quoted(name));
                (message, Some("give the parameter another name".to_owned()))
            }),
        }
    }

    pub(super) fn refuse_parameter(&mut self, table: &Node, name: &str, (message, help): (String, Option<String>)) {
        self.report.error(key_span(table, name), self.report.fitted(&message), help);
    }
}

pub(super) fn along_a_curve() -> (String, Option<String>) {
    ("`s` already has a meaning in curves: give the parameter another name".to_owned(), None)
}
