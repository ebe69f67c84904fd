//! Uses of parameters: from a text where a number stands to the number of the engine's part that it gives.
//!
//! A number is bound where the engine's part has it under the same key. Other numbers (of bodies, of blocks, those from
//! which others were computed or measured) belong to the structure: a scene in which they change is built anew.

use super::Assembly;
use crate::model::Parameter;
use crate::parameters::{Use, ways};
use crate::tree::{Node, Step};
use qhat::{Expression, ForceId, Quantity};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The parts that tables have become, and the numbers measured or weighed on the way.
#[derive(Debug, Default)]
pub(super) struct Made {
    /// The constraints of each entry of `[[constraints]]`.
    pub(super) constraints: Vec<Range<usize>>,
    /// The forces of each entry of `[[springs]]` and of `[[loads]]`.
    pub(super) springs: Vec<Range<usize>>,
    pub(super) loads: Vec<Range<usize>>,
    pub(super) gravity: Option<ForceId>,
    pub(super) drag: Option<ForceId>,
    /// Whether a number was measured at the start, or computed from a mass.
    pub(super) is_measured: Cell<bool>,
    pub(super) is_weighed: Cell<bool>,
    /// The parameters in expressions, each with the place of the expression.
    pub(super) in_expressions: RefCell<BTreeSet<(String, usize)>>,
}

impl Assembly<'_, '_, '_> {
    /// x of all particles at the start [m], flat, to measure a number.
    pub(super) fn start_positions(&self) -> &[f64] {
        self.made.is_measured.set(true);
        &self.positions
    }

    /// m of a particle [kg], to compute another number.
    pub(super) fn weighed(&self, particle: qhat::ParticleId) -> f64 {
        self.made.is_weighed.set(true);
        self.builder.mass(particle)
    }

    /// Adds the parameters to the builder; reports those that cannot be parameters.
    pub(super) fn take_parameters(&mut self, parameters: &BTreeMap<String, Parameter>) {
        let table = self.tree.key("parameters");
        for (name, parameter) in table.entries().iter().filter_map(|entry| parameters.get_key_value(&entry.key)) {
            let value = parameter.value();
            let is_along_a_curve = || (name == "s").then(super::expressions::along_a_curve);
            let parameter = parameter.named(name);
            let added = match self.wrong_parameter(name, value).or_else(is_along_a_curve) {
                Some(wrong) => Err(wrong),
                None if parameter.range[0] > parameter.range[1] => {
                    let message = format!("`min` of the parameter {} is above `max`", self.report.quoted(name));
                    Err((message, Some("exchange them".to_owned())))
                }
                None => self.builder.parameter(parameter).map_err(|reason| (reason.to_string(), None)),
            };
            match added {
                Ok(_) => drop(self.parameters.insert(name.clone(), value)),
                Err(wrong) => self.refuse_parameter(table, name, wrong),
            }
        }
    }

    /// Declares the uses of parameters to the builder.
    pub(super) fn declare(&mut self, uses: Vec<Use>) {
        let names: Vec<String> = self.tree.key("parameters").entries().iter().map(|entry| entry.key.clone()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let in_expressions = self.made.in_expressions.take();
        if uses.is_empty() && in_expressions.is_empty() {
            return;
        }
        let ways = ways(self.tree);
        for Use { expression, place } in uses {
            let way = ways.get(&place.start).map_or(&[][..], Vec::as_slice);
            let quantity = self.quantity(way);
            self.declare_one(way, &place, quantity, expression);
        }
        for (name, start) in in_expressions {
            let way = ways.get(&start).map_or(&[][..], Vec::as_slice);
            // The name has passed the checks of a parameter.
            if let Ok(expression) = Expression::of_parameters(&name, &names, &|_, _| None) {
                self.declare_one(way, &(start..start), None, expression);
            }
        }
    }

    fn declare_one(
        &mut self,
        way: &[Step<'_>],
        place: &Range<usize>,
        quantity: Option<Quantity>,
        expression: Expression,
    ) {
        let key = way.iter().rev().find_map(|step| if let Step::Key(key) = step { Some(*key) } else { None });
        let named = format!("{} in line {}", key.unwrap_or("number"), self.report.line_of(place.start));
        if let Err(error) = self.builder.depends_at(named, quantity, expression) {
            self.report.error(place.clone(), error.to_string(), None);
        }
    }

    /// The number of a part that the value at the end of a way gives; `None` where it belongs to the structure.
    fn quantity(&mut self, way: &[Step<'_>]) -> Option<Quantity> {
        let (way, k) = match way {
            [way @ .., Step::Place(k)] => (way, *k),
            way => (way, 0),
        };
        let quantity = match way {
            [Step::Key("particles"), Step::Place(place), Step::Key(key)] => {
                let particle = self.builder.particle_at(*place)?;
                match *key {
                    "mass" if !self.made.is_weighed.get() => Quantity::Mass(particle),
                    "at" if !self.made.is_measured.get() => Quantity::Position(particle, k),
                    "velocity" => Quantity::Velocity(particle, k),
                    _ => return None,
                }
            }
            [Step::Key("forces"), Step::Key("gravity")] => {
                Quantity::Force(self.made.gravity?, "acceleration".to_owned(), k)
            }
            [Step::Key("forces"), Step::Key("drag")] => Quantity::Force(self.made.drag?, "coefficient".to_owned(), k),
            [Step::Key("feedback"), Step::Key(key)] => Quantity::Feedback((*key).to_owned()),
            [Step::Key("constraints"), Step::Place(place), Step::Key(key)] => {
                let made = self.made.constraints.get(*place)?.clone();
                Quantity::Constraint(self.builder.constraint_at(only(made)?)?, (*key).to_owned(), k)
            }
            [Step::Key("springs"), Step::Place(place), Step::Key(key)] => {
                let made = self.made.springs.get(*place)?.clone();
                Quantity::Force(self.builder.force_at(only(made)?)?, (*key).to_owned(), k)
            }
            [Step::Key("loads"), Step::Place(place), Step::Key(key)] => {
                let made = self.made.loads.get(*place)?.clone();
                Quantity::Force(self.builder.force_at(only(made)?)?, (*key).to_owned(), k)
            }
            _ => return None,
        };
        self.builder.number(&quantity).is_some().then_some(quantity)
    }
}

/// The place of the only part that an entry has become.
fn only(made: Range<usize>) -> Option<usize> {
    (made.len() == 1).then_some(made.start)
}

/// The place of a key of a table; the place of the table where the key is missing.
pub(super) fn key_span(table: &Node, key: &str) -> Range<usize> {
    let entry = table.entries().iter().find(|entry| entry.key == key);
    entry.map_or_else(|| table.span.clone(), |entry| entry.key_span.clone())
}
