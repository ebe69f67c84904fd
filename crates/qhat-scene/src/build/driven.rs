//! Driven numbers, and constraints whose number is measured at the start where it is left out.

use super::Assembly;
use crate::model::{Driven, DrivenVector, Named, Parameters};
use crate::tree::Node;
use qhat::{Constraint, Purpose};

impl Assembly<'_, '_, '_> {
    /// The number or function of t. A text without t becomes the number that it stands for.
    pub(super) fn schedule(&mut self, driven: &Driven, place: &Node) -> Option<qhat::Driven> {
        match driven {
            Driven::Number(number) => Some(qhat::Driven::Constant(*number)),
            Driven::Text(text) => {
                let function = self.expression(text, Purpose::Time, &Parameters::new(), place)?;
                let is_number = !function.uses_time();
                Some(if is_number { function.value(&[], &[], 0.0).into() } else { function.into() })
            }
        }
    }

    /// Three driven numbers, as the engine takes points: z = 0 in two dimensions.
    pub(super) fn schedules(&mut self, driven: &DrivenVector, place: &Node) -> Option<[qhat::Driven; 3]> {
        let mut schedules = [0.0; 3].map(qhat::Driven::Constant);
        let mut complete = true;
        for (index, component) in driven.0.iter().enumerate() {
            match self.schedule(component, place.item(index)) {
                Some(schedule) => schedules[index] = schedule,
                None => complete = false,
            }
        }
        complete.then_some(schedules)
    }

    /// The driven numbers that the scene gives, or else those at the start.
    pub(super) fn schedules_or(
        &mut self,
        driven: Option<&DrivenVector>,
        place: &Node,
        start: [f64; 3],
    ) -> Option<[qhat::Driven; 3]> {
        match driven {
            Some(driven) => self.schedules(driven, place),
            None => Some(start.map(qhat::Driven::Constant)),
        }
    }

    /// Adds a constraint for the number that the scene gives, or for the number that it has at the start. `place` is
    /// the table of the constraint and the key of the number.
    pub(super) fn add_driven(
        &mut self,
        it: &impl Named,
        given: Option<&Driven>,
        (table, key): (&Node, &str),
        make: impl Fn(qhat::Driven) -> Constraint,
    ) -> Option<()> {
        let schedule = match given {
            Some(driven) => self.schedule(driven, table.key(key))?,
            None => {
                let at_start = make(0.0.into()).residual(self.dimension_of_system(), self.start_positions());
                let [measured] = at_start[..] else { unreachable!("a driven constraint has one row") };
                if !measured.is_finite() {
                    let message = format!("`{key}` cannot be measured at the start");
                    let help = "move apart particles that are at the same place, and nearer those that are too far";
                    self.report.error(table.span.clone(), message, Some(help.into()));
                    return None;
                }
                measured.into()
            }
        };
        let name = self.name_of(it);
        self.builder.constraint(name, make(schedule));
        Some(())
    }
}
