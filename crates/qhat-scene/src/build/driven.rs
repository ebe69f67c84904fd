//! Expressions inside a scene: read, with what is wrong pointed at in the text.

use super::Assembly;
use crate::model::{Driven, DrivenVector};
use crate::tree::Node;
use qhat::{Dimension, Expression, Purpose, Schedule, Scope};

impl Assembly<'_, '_, '_> {
    /// The expression in the text at `place`, or `None` after telling what is wrong with it.
    pub(super) fn expression(&mut self, text: &str, purpose: Purpose, place: &Node) -> Option<Expression> {
        let dimension = if self.dimension == 2 { Dimension::Two } else { Dimension::Three };
        let ids = &self.ids;
        let parsed = Expression::parse(text, &Scope::new(purpose, dimension, &|name| ids.find(name)));
        parsed
            .map_err(|error| {
                // Behind the quotation mark, unless the text was written with escapes.
                let start = place.span.start + 1;
                let plain = self.report.written(&(start..start + text.len())) == text;
                let within = start + error.span.start..start + error.span.end;
                let span = if plain { within } else { place.span.clone() };
                self.report.error(span, error.message, error.help);
            })
            .ok()
    }

    pub(super) fn schedule(&mut self, driven: &Driven, place: &Node) -> Option<Schedule> {
        match driven {
            Driven::Number(number) => Some(Schedule::Constant(*number)),
            Driven::Text(text) => self.expression(text, Purpose::Time, place).map(Schedule::Function),
        }
    }

    /// As the engine takes points: z = 0 in two dimensions.
    pub(super) fn schedules(&mut self, driven: &DrivenVector, place: &Node) -> Option<[Schedule; 3]> {
        let mut schedules = [0.0; 3].map(Schedule::Constant);
        let mut complete = true;
        for (index, component) in driven.0.iter().enumerate() {
            match self.schedule(component, place.item(index)) {
                Some(schedule) => schedules[index] = schedule,
                None => complete = false,
            }
        }
        complete.then_some(schedules)
    }

    /// Those that are given, else the numbers of the start.
    pub(super) fn schedules_or(
        &mut self,
        driven: Option<&DrivenVector>,
        place: &Node,
        start: [f64; 3],
    ) -> Option<[Schedule; 3]> {
        match driven {
            Some(driven) => self.schedules(driven, place),
            None => Some(start.map(Schedule::Constant)),
        }
    }
}
