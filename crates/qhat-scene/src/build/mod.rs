//! From the model to the engine's System and State: resolves ids, fills in defaults, and checks every condition between
//! keys. A family of kinds has a file of the same name in `model`.

mod bodies;
mod constraints;
mod contacts;
mod curves;
mod driven;
mod enclosed;
mod expectations;
mod expressions;
mod fields;
mod generated;
mod ids;
mod incidence;
mod lengths;
mod lines;
mod loads;
mod particles;
mod pressure;
mod resolve;
mod rods;
mod springs;
mod uses;
mod wheels;

use crate::model::{Document, Parameters, Step};
use crate::parameters::Use;
use crate::report::Report;
use crate::scene::{Scene, SceneBody};
use crate::tree::Node;
use expressions::Untried;
use ids::Ids;
use qhat::{BuildError, Dimension, Drag, Feedback, Gravity, Settings, System, SystemBuilder};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use uses::Made;

/// The most particles of a scene. More would fill the memory of a browser before the first frame.
const MOST_PARTICLES: u64 = 1_000_000;

/// The places in the text of the constraints that the engine may still refuse, by name.
type Places = HashMap<String, Range<usize>>;

/// A scene under construction.
struct Assembly<'a, 'r, 't> {
    tree: &'a Node,
    report: &'r mut Report<'t>,
    builder: SystemBuilder,
    dimension: usize,
    /// x of all particles at the start [m], flat, for lengths that are left out.
    positions: Vec<f64>,
    /// Whether each particle is fixed.
    is_fixed: Vec<bool>,
    ids: Ids,
    /// The numbers that every expression of the scene may refer to.
    parameters: Parameters,
    constraint_names: HashSet<String>,
    /// The number to try next behind a default name that is taken.
    next_numbers: HashMap<String, u64>,
    /// Forces as expressions, whose values at the start have yet to be checked.
    untried: Vec<Untried>,
    places: Places,
    /// The place in the text of the constraint that is being added.
    adding: Range<usize>,
    made: Made,
    bodies: Vec<SceneBody>,
}

/// The scene, or `None` after reporting every error.
pub(crate) fn build(document: Document, tree: &Node, uses: Vec<Use>, report: &mut Report<'_>) -> Option<Scene> {
    let (number, dimension) = if document.dimension == 2 { (2, Dimension::Two) } else { (3, Dimension::Three) };
    let mut assembly = Assembly {
        tree,
        report,
        builder: System::builder(dimension),
        dimension: number,
        positions: Vec::new(),
        is_fixed: Vec::new(),
        ids: Ids::default(),
        parameters: Parameters::new(),
        constraint_names: HashSet::new(),
        next_numbers: HashMap::new(),
        untried: Vec::new(),
        places: Places::new(),
        adding: 0..0,
        made: Made::default(),
        bodies: Vec::new(),
    };
    assembly.add_all(&document)?;
    assembly.declare(uses);
    let Assembly { builder, report, ids, untried, places, bodies, .. } = assembly;
    let (system, state) = match builder.build() {
        Ok(built) => built,
        Err(error) => {
            report.error(place_of(&error, tree, &ids, &places), error.to_string(), None);
            return None;
        }
    };
    untried.iter().for_each(|force| force.try_at(&state, report));
    if !report.is_empty() {
        return None;
    }
    let settings = settings(&document.step);
    if let Err(error) = settings.check() {
        report.error(tree.key("step").span.clone(), error.to_string(), None);
        return None;
    }
    contacts::check_start(&system, &state, &settings, (tree, &ids, &places), report);
    if !report.is_empty() {
        return None;
    }
    let Document { name, description, expect, step, .. } = document;
    let duration = step.duration;
    Some(Scene { name, description, system, state, settings, duration, expect, bodies, source: None })
}

fn settings(step: &Step) -> Settings {
    Settings {
        h: step.h,
        integrator: step.integrator.0,
        tolerance: step.tolerance,
        constraint_tolerance: step.constraint_tolerance,
        max_substeps: step.max_substeps as usize,
        frame_budget: step.frame_budget as usize,
        frame_work: step.frame_work as usize,
    }
}

impl Assembly<'_, '_, '_> {
    /// Adds all tables of the scene; `None` after an error.
    fn add_all(&mut self, document: &Document) -> Option<()> {
        let clean = self.report.is_empty();
        self.take_constraint_names(&document.constraints);
        self.add_particles(&document.particles);
        let unlinked = self.add_generated(&document.generate)?;
        let unheld = self.add_bodies(&document.bodies)?;
        if document.particles.is_empty() && document.generate.is_empty() && document.bodies.is_empty() {
            let help = "add `[[particles]]` with an `id` and `at`, `[[generate]]` or `[[bodies]]`".to_owned();
            self.report.error(0..0, "the scene has no particles", Some(help));
            return None;
        }
        self.take_parameters(&document.parameters);
        self.add_constraints(&document.constraints);
        self.add_links(&unlinked);
        self.hold_bodies(unheld);
        self.add_springs(&document.springs);
        self.add_loads(&document.loads);
        if let Some(gravity) = &document.forces.gravity {
            self.made.gravity = Some(self.builder.force(Gravity { acceleration: gravity.padded() }));
        }
        if document.forces.drag > 0.0 {
            self.made.drag = Some(self.builder.force(Drag { coefficient: document.forces.drag }));
        }
        let crate::model::Feedback { ks, kd, diagonal_drag, elasticity } = document.feedback;
        self.builder.feedback(Feedback { ks, kd, diagonal_drag, elasticity });
        if let Some(expect) = &document.expect {
            self.check_expectations(expect);
        }
        (clean && self.report.is_empty()).then_some(())
    }

    fn dimension_of_system(&self) -> Dimension {
        if self.dimension == 2 { Dimension::Two } else { Dimension::Three }
    }
}

/// The place in the text of an error that only the engine found.
fn place_of(error: &BuildError, tree: &Node, ids: &Ids, places: &Places) -> Range<usize> {
    match error {
        BuildError::Particle { name, .. } => ids.origin(name).unwrap_or(0..0),
        BuildError::Constraint { name, .. } | BuildError::TooLarge { constraint: name, .. }
            if places.contains_key(name) =>
        {
            places[name].clone()
        }
        BuildError::Constraint { .. } | BuildError::TooLarge { .. } => tree.key("constraints").span.clone(),
        BuildError::Force { .. } => tree.key("forces").span.clone(),
        BuildError::Settings(_) => tree.key("feedback").span.clone(),
        _ => 0..0,
    }
}
