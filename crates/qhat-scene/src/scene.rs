//! A scene, ready to simulate.

use crate::model::Expect;
use qhat::{Settings, Simulation, State, StepError, System};

/// A scene, ready to simulate.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The title people see.
    pub name: String,
    /// One or two sentences that say what there is to see; may be empty.
    pub description: String,
    /// Particles, constraints and forces.
    pub system: System,
    /// Where the file says it starts. An integrator that projects starts from the nearest consistent state.
    pub state: State,
    /// How to step.
    pub settings: Settings,
    /// How long a run is \[s\].
    pub duration: f64,
    /// What the scene must show.
    pub expect: Option<Expect>,
}

impl Scene {
    /// A simulation that starts where the scene starts.
    ///
    /// # Errors
    /// When the integrator projects and no positions near by satisfy the constraints.
    pub fn simulation(&self) -> Result<Simulation, StepError> {
        Simulation::new(self.system.clone(), self.state.clone(), self.settings)
    }
}
