//! qhat in the browser: conversions between the engine's types and JavaScript values. No physics is computed here.
//!
//! The types of these values are declared in `types.d.ts` beside this file and become part of the generated
//! declarations.

mod convert;
mod record;

use qhat::{BindError, ForceError, Integrator, Settings};
use qhat_scene::{Format, Scene};
use record::{Record, error, list};
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = include_str!("types.d.ts");

#[wasm_bindgen]
extern "C" {
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Controls")]
    pub type Controls;
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Structure")]
    pub type Structure;
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Energy")]
    pub type Energy;
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "StepReport")]
    pub type StepReport;
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Projection")]
    pub type Projection;
    /// A record of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Terms")]
    pub type Terms;
    /// A list of records of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Shape[]")]
    pub type Shapes;
    /// A list of records of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Shipped[]")]
    pub type ShippedScenes;
    /// A list of records of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "IntegratorFacts[]")]
    pub type Integrators;
    /// A list of records of `types.d.ts`.
    #[wasm_bindgen(typescript_type = "Parameter[]")]
    pub type Parameters;
    /// A list of strings.
    #[wasm_bindgen(typescript_type = "string[]")]
    pub type Strings;
}

/// The scenes that ship with qhat.
#[wasm_bindgen]
pub fn shipped_scenes() -> ShippedScenes {
    let scenes = qhat_scene::shipped().iter();
    let records = scenes.map(|scene| {
        Record::new()
            .with("name", scene.name)
            .with("title", scene.title)
            .with("group", scene.group)
            .with("text", scene.text)
    });
    list(records).unchecked_into()
}

/// The integrators, with the properties that help a person to choose.
#[wasm_bindgen]
pub fn integrators() -> Integrators {
    let records = Integrator::ALL.map(|integrator| {
        Record::new()
            .with("name", integrator.name())
            .with("projects", integrator.projects())
            .with("adaptive", integrator.is_adaptive())
    });
    list(records).unchecked_into()
}

/// The limit of row solves in a frame for `auto`, if a scene does not give one.
#[wasm_bindgen]
pub fn default_frame_work() -> f64 {
    Settings::default().frame_work as f64
}

/// A running simulation of a scene.
#[wasm_bindgen]
pub struct Simulation {
    inner: qhat::Simulation,
    scene: Scene,
}

#[wasm_bindgen]
impl Simulation {
    /// Reads a scene and starts it. The scene is JSON if the name of its source ends in `.json`, else TOML. Throws
    /// `SceneErrors` or `StepError`.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, source_name: &str) -> Result<Simulation, JsValue> {
        let scene = qhat_scene::load(text, source_name, Format::from_path(source_name))
            .map_err(|cause| error("SceneErrors", cause))?;
        let inner = scene.simulation().map_err(|cause| error("StepError", cause))?;
        Ok(Simulation { inner, scene })
    }

    /// The structure of the scene, in the present formulation.
    pub fn structure(&self) -> Structure {
        let Scene { name, description, duration, .. } = &self.scene;
        convert::structure(&self.inner, name, description, *duration)
    }

    /// The parameters of the scene, with their present values.
    pub fn parameters(&self) -> Parameters {
        list(self.scene.system.parameters().iter().map(convert::parameter)).unchecked_into()
    }

    /// Gives the parameters new values, one for each, and goes back to the start that follows from them, with the
    /// settings and the forces of the scene. Throws `BindError`, `SceneErrors` or `StepError`; nothing is
    /// changed then.
    pub fn bind(&mut self, values: &[f64]) -> Result<(), JsValue> {
        let parameters = self.scene.system.parameters();
        if values.len() != parameters.len() {
            let (wanted, given) = (parameters.len(), values.len());
            return Err(error("BindError", BindError::Count { wanted, given }));
        }
        let checked = parameters.iter().zip(values).try_for_each(|(parameter, &value)| parameter.check(value));
        checked.map_err(|cause| error("BindError", cause))?;
        let mut scene = self.scene.clone();
        scene.bind(values).map_err(|cause| error("SceneErrors", cause))?;
        self.inner = scene.simulation().map_err(|cause| error("StepError", cause))?;
        self.scene = scene;
        Ok(())
    }

    /// The simulation as bytes, from which [`Simulation::restore`] goes on with the same bits in another process.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.inner.to_bytes()
    }

    /// Takes the state of bytes that a simulation of the same scene gave. Throws `RestoreError`; nothing is changed
    /// then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), JsValue> {
        let restored = qhat::Simulation::restore(self.scene.system.clone(), bytes);
        self.inner = restored.map_err(|cause| error("RestoreError", cause))?;
        Ok(())
    }

    /// The driven shapes at a time \[s\], in the same order as among the shapes of the structure.
    pub fn driven_shapes(&self, time: f64) -> Shapes {
        let (system, state) = (self.inner.system(), self.inner.state());
        convert::shapes(system, &qhat_shapes::driven_shapes(system, state, time))
    }

    /// t \[s\].
    pub fn time(&self) -> f64 {
        self.inner.state().time()
    }

    /// q \[m\]; a copy.
    pub fn positions(&self) -> Vec<f64> {
        self.inner.state().positions().to_vec()
    }

    /// q̇ \[m/s\]; a copy.
    pub fn velocities(&self) -> Vec<f64> {
        self.inner.state().velocities().to_vec()
    }

    /// Tension of every link \[N\], positive if the link pulls its ends together, 0 while slack.
    pub fn tension(&mut self) -> Vec<f64> {
        self.inner.tension()
    }

    /// The indices of the broken links.
    pub fn broken(&self) -> Vec<u32> {
        let broken = self.inner.system().broken_links(self.inner.state());
        broken.into_iter().map(|place| place as u32).collect()
    }

    /// The energy account.
    pub fn energy(&self) -> Energy {
        convert::energy(&self.inner.energy()).finish()
    }

    /// Every symbol of the equation at this state.
    pub fn terms(&mut self) -> Terms {
        convert::terms(&self.inner.terms())
    }

    /// The projection that made the start consistent.
    pub fn projection(&self) -> Projection {
        convert::projection(self.inner.projection())
    }

    /// One step of h. Throws `StepError`; the last good state is kept.
    pub fn step(&mut self) -> Result<StepReport, JsValue> {
        let report = self.inner.step().map_err(|cause| error("StepError", cause))?;
        Ok(convert::report(&report, self.inner.warnings()))
    }

    /// Returns to the start and releases the hand; the controls are kept. Throws `StepError`.
    pub fn reset(&mut self) -> Result<(), JsValue> {
        self.inner.reset().map_err(|cause| error("StepError", cause))
    }

    /// The values of all controls of the page.
    pub fn controls(&self) -> Controls {
        convert::controls(&self.inner)
    }

    /// Sets the controls that differ from the present ones. Throws `SettingsError`, `ForceError` or `StepError`.
    pub fn set_controls(&mut self, controls: &Controls) -> Result<(), JsValue> {
        convert::set_controls(&mut self.inner, controls)
    }

    /// Takes hold of a particle with a mouse spring towards a target \[m\]. Throws `ForceError`.
    pub fn grab(&mut self, particle: usize, target: &[f64]) -> Result<(), JsValue> {
        let id = self.inner.system().particle_at(particle).ok_or(ForceError::NoParticle { particle });
        id.and_then(|id| self.inner.grab(id, convert::target(target))).map_err(|cause| error("ForceError", cause))
    }

    /// Moves the target of the mouse spring \[m\]. Throws `ForceError`.
    pub fn drag_to(&mut self, target: &[f64]) -> Result<(), JsValue> {
        self.inner.drag_to(convert::target(target)).map_err(|cause| error("ForceError", cause))
    }

    /// Removes the mouse spring.
    pub fn release(&mut self) {
        self.inner.release();
    }
}
