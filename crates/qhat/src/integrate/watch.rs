//! TensionWatch: the largest tension at the ends of the substeps of a frame.
//!
//! No method has λ at the end of every substep: open chains solve for accelerations alone, and Runge–Kutta methods know
//! λ at their stages. So the watch solves the equation once more a substep, in arrays of its own: whether a simulation
//! is watched does not change a bit of its motion.

use super::Workspace;
use crate::report::MaxTension;
use crate::settings::{Feedback, Settings};
use crate::space::{ConstraintId, in_dimension};
use crate::state::State;
use crate::system::System;

/// Margin to a singular position below which tensions are not noted: they are ill determined there, by the error of C
/// over the third power of a sine.
const NEAR: f64 = 1e-2;

/// The largest tension of the frame so far.
#[derive(Clone, Debug)]
pub(crate) struct TensionWatch {
    workspace: Box<Workspace>,
    feedback: Feedback,
    largest: Option<MaxTension>,
}

impl TensionWatch {
    /// A watch over a system.
    fn new(system: &System) -> Self {
        TensionWatch { workspace: Box::new(Workspace::new(system)), feedback: Feedback::NONE, largest: None }
    }

    /// Takes the tensions at a state.
    pub(crate) fn note(&mut self, system: &System, state: &State) {
        let links = system.constraints.iter().enumerate().filter(|(_, named)| named.constraint.as_link().is_some());
        let tensions = self.workspace.tension(system, state, &self.feedback);
        let is_unique = self.workspace.tension_is_unique(system);
        let margin = in_dimension!(system.dimension, D => self.workspace.equation.margin::<D>(system));
        if margin.is_some_and(|margin| margin < NEAR) {
            return;
        }
        let links = links.zip(tensions).zip(is_unique);
        for (((place, _), tension), is_unique) in links.filter(|(((place, _), _), _)| !system.is_second_order(*place)) {
            let largest = MaxTension { tension, link: ConstraintId(place), time: state.t, is_unique };
            self.largest = MaxTension::larger(self.largest, Some(largest));
        }
    }
}

impl Workspace {
    /// Records the largest tension of every frame from now on, or stops to.
    pub(crate) fn watch_tension(&mut self, system: &System, is_watched: bool) {
        self.watch = is_watched.then(|| TensionWatch::new(system));
    }

    /// Whether the largest tension is recorded.
    #[cfg(feature = "serde")]
    pub(crate) fn watches_tension(&self) -> bool {
        self.watch.is_some()
    }

    /// Arrays for another system, or the same one changed, that go on recording.
    pub(crate) fn renewed(&self, system: &System) -> Workspace {
        let mut workspace = Workspace::new(system);
        workspace.watch_tension(system, self.watch.is_some());
        workspace
    }

    /// Begins the record of a frame.
    pub(super) fn begin_watch(&mut self, system: &System, settings: &Settings) {
        if let Some(watch) = &mut self.watch {
            watch.feedback = settings.feedback_in_use(system.feedback);
            watch.largest = None;
        }
    }

    /// The largest tension of the frame; `None` unless it is watched.
    pub(super) fn largest_tension(&mut self) -> Option<MaxTension> {
        self.watch.as_mut()?.largest.take()
    }
}
