//! Numbers that may follow the time.

use super::Assembly;
use crate::model::{Driven, DrivenVector, Parameters};
use crate::tree::Node;
use qhat::{Purpose, Schedule};

impl Assembly<'_, '_, '_> {
    pub(super) fn schedule(&mut self, driven: &Driven, place: &Node) -> Option<Schedule> {
        match driven {
            Driven::Number(number) => Some(Schedule::Constant(*number)),
            Driven::Text(text) => {
                self.expression(text, Purpose::Time, &Parameters::new(), place).map(Schedule::Function)
            }
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
