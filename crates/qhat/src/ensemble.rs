//! Many systems at once.

use crate::error::StepError;
use crate::report::StepReport;
use crate::simulation::Simulation;
use crate::threads;

/// Steps every simulation once, on all cores where there are several. They know nothing of each other, so the bits are those
/// of stepping one after the other.
///
/// One outcome each, in their order: see [`Simulation::step`].
pub fn step_all(simulations: &mut [Simulation]) -> Vec<Result<StepReport, StepError>> {
    match simulations {
        [] => Vec::new(),
        [one] => vec![one.step()],
        many => {
            let (left, right) = many.split_at_mut(many.len() / 2);
            let (mut outcomes, rest) = threads::both(|| step_all(left), || step_all(right));
            outcomes.extend(rest);
            outcomes
        }
    }
}
