//! A scene, ready to simulate.

use crate::error::SceneErrors;
use crate::load::{Format, load_with};
use crate::model::Expect;
use qhat::{ParticleId, Settings, Simulation, State, StepError, System};
use std::sync::Arc;

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
    /// The rigid bodies, in the order of the file.
    pub bodies: Vec<SceneBody>,
    /// The text of a scene with parameters, from which it is built anew.
    pub(crate) source: Option<Source>,
}

/// A rigid body of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBody {
    /// The prefix of the ids of its particles.
    pub name: String,
    /// Its particles.
    pub particles: Vec<ParticleId>,
}

/// The text of a scene.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    text: Arc<str>,
    name: Arc<str>,
    format: Format,
}

impl Source {
    pub(crate) fn new(text: &str, name: &str, format: Format) -> Self {
        Source { text: text.into(), name: name.into(), format }
    }
}

impl Scene {
    /// Gives the parameters new values, one for each, in the order of [`System::parameters`]. Where all numbers that
    /// change are those of parts ([`ParameterUse::is_bindable`](qhat::ParameterUse::is_bindable)), the system that is
    /// built takes them ([`System::bind`]); else the scene is built anew from its text. The bits are the same.
    ///
    /// ```
    /// let text = r#"
    /// schema = "qhat/1"
    /// name = "Pendulum"
    /// dimension = 2
    /// parameters = { L = { value = 1.0, min = 0.1, max = 5.0, unit = "m" } }
    /// particles = [{ id = "pivot", at = [0, 0], fixed = true }, { id = "bob", at = [0, "-L"] }]
    /// constraints = [{ kind = "distance", between = ["pivot", "bob"], length = "L" }]
    /// "#;
    /// let mut scene = qhat_scene::load(text, "pendulum.toml", qhat_scene::Format::Toml)?;
    /// scene.bind(&[2.5])?;
    /// assert_eq!(scene.state.positions(), [0.0, 0.0, 0.0, -2.5]);
    /// # Ok::<(), qhat_scene::SceneErrors>(())
    /// ```
    ///
    /// # Errors
    /// Those of a scene with these numbers. Nothing is changed then.
    ///
    /// # Panics
    /// If the number of values is not that of the parameters.
    pub fn bind(&mut self, values: &[f64]) -> Result<(), SceneErrors> {
        let parameters = self.system.parameters();
        assert_eq!(values.len(), parameters.len(), "one value for each parameter");
        let Some(source) = &self.source else { return Ok(()) };
        // A value that is refused is refused by the text, too, with its place there.
        if self.system.bind(values).is_ok() {
            self.state = self.system.start();
        } else {
            let names = self.system.parameters().iter().map(|parameter| parameter.name.clone());
            let set: Vec<_> = names.zip(values.iter().copied()).collect();
            *self = load_with(&source.text, &source.name, source.format, &set)?;
        }
        Ok(())
    }

    /// A simulation from the start of the scene.
    ///
    /// # Errors
    /// No positions near the start satisfy the constraints, under an integrator that projects.
    pub fn simulation(&self) -> Result<Simulation, StepError> {
        Simulation::new(self.system.clone(), self.state.clone(), self.settings)
    }
}
