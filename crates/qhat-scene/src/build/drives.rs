//! Numbers that may change with time, and what they are measured as where they are left out.

use super::Assembly;
use crate::model::Drive;
use crate::tree::Node;
use qhat::{Constraint, Dimension, Expression, Purpose, Schedule, Scope};

impl Assembly<'_, '_, '_> {
    /// Adds a constraint made for what is given, or for what it has at the start.
    pub(super) fn add_driven(
        &mut self,
        name: String,
        given: &Option<Drive>,
        place: (&Node, &str),
        make: impl Fn(Schedule) -> Constraint,
    ) -> Option<()> {
        let (table, key) = place;
        let schedule = match given {
            Some(drive) => self.schedule(drive, table.key(key))?,
            None => {
                let at_start = make(0.0.into()).residual(self.dimension_of_system(), &self.positions);
                let [measured] = at_start[..] else { unreachable!("what is driven has one row") };
                if !measured.is_finite() {
                    let message = format!("what `{key}` is at the start cannot be measured");
                    let help =
                        "move apart particles that are at the same place, or bring nearer what is too far".to_owned();
                    self.report.error(table.span.clone(), message, Some(help));
                    return None;
                }
                measured.into()
            }
        };
        self.places.insert(name.clone(), table.span.clone());
        self.builder.constraint(name, make(schedule));
        Some(())
    }

    /// A number, or an expression of t alone.
    fn schedule(&mut self, drive: &Drive, place: &Node) -> Option<Schedule> {
        let text = match drive {
            Drive::Number(number) => return Some((*number).into()),
            Drive::Text(text) => text,
        };
        let particle = |name: &str| self.ids.find(name);
        match Expression::parse(text, &Scope::new(Purpose::Time, self.dimension_of_system(), &particle)) {
            Ok(function) => Some(function.into()),
            Err(error) => {
                self.report.error(place.span.clone(), error.message, error.help);
                None
            }
        }
    }

    pub(super) fn dimension_of_system(&self) -> Dimension {
        if self.dimension == 2 { Dimension::Two } else { Dimension::Three }
    }
}
