//! A scene, ready to simulate.

use crate::model::Expect;
use qhat::{Settings, Simulation, State, StepError, System};

/// A scene, ready to simulate.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The title.
    pub name: String,
    /// One or two sentences on what the scene shows; may be empty.
    pub description: String,
    /// Particles, constraints and forces.
    pub system: System,
    /// The state at the start, as the file gives it. An integrator that projects starts from the nearest consistent
    /// state.
    pub state: State,
    /// The settings of a run.
    pub settings: Settings,
    /// The duration of a run \[s\].
    pub duration: f64,
    /// The results that the scene must show.
    pub expect: Option<Expect>,
}

impl Scene {
    /// A simulation from the start of the scene.
    ///
    /// # Errors
    /// No positions near the start satisfy the constraints, under an integrator that projects.
    pub fn simulation(&self) -> Result<Simulation, StepError> {
        Simulation::new(self.system.clone(), self.state.clone(), self.settings)
    }
}
