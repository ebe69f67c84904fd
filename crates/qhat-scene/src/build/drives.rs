//! Constraints whose number, which may follow the time, is measured at the start where it is left out.

use super::Assembly;
use crate::model::Driven;
use crate::tree::Node;
use qhat::{Constraint, Dimension, Schedule};

impl Assembly<'_, '_, '_> {
    /// Adds a constraint made for what is given, or for what it has at the start.
    pub(super) fn add_driven(
        &mut self,
        name: String,
        given: &Option<Driven>,
        place: (&Node, &str),
        make: impl Fn(Schedule) -> Constraint,
    ) -> Option<()> {
        let (table, key) = place;
        let schedule = match given {
            Some(driven) => self.schedule(driven, table.key(key))?,
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

    pub(super) fn dimension_of_system(&self) -> Dimension {
        if self.dimension == 2 { Dimension::Two } else { Dimension::Three }
    }
}
