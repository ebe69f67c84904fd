//! The scene file as Rust types, the only list of its keys. The JSON Schema is made from these types, `check` follows
//! the schema, and serde fills the types. The comment on a key is its description in the schema and in the help of
//! messages.

pub(crate) mod body;
pub(crate) mod constraint;
pub(crate) mod contact;
pub(crate) mod curves;
mod driven;
pub(crate) mod enclosed;
mod expect;
pub(crate) mod expression;
pub(crate) mod fields;
pub(crate) mod generate;
pub(crate) mod incidence;
mod integrator;
pub(crate) mod lengths;
pub(crate) mod lines;
pub(crate) mod load;
mod parameter;
pub(crate) mod point;
pub(crate) mod pressure;
pub(crate) mod rods;
pub(crate) mod springs;
mod step;
mod value;
pub(crate) mod wheels;

pub(crate) use constraint::{Constraint, Named};
pub(crate) use driven::{Driven, DrivenVector};
pub use expect::{AtEnd, Axis, Expect, Motion, Period, SpeedAtEnd, Tension};
pub(crate) use expression::Parameters;
pub(crate) use generate::Generate;
pub(crate) use load::Load;
pub(crate) use parameter::Parameter;
pub(crate) use springs::Spring;
pub(crate) use step::{Feedback, Forces, Step};
pub(crate) use value::{Id, Name, PATTERNS, Vector};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A scene of qhat: particles, constraints, forces, and the settings of a run. SI units.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
#[schemars(title = "qhat scene")]
pub(crate) struct Document {
    /// The version of the format.
    pub(crate) schema: Version,
    /// The title of the scene.
    #[schemars(length(min = 1, max = 100))]
    pub(crate) name: String,
    /// One or two sentences on what the scene shows.
    #[serde(default)]
    #[schemars(length(max = 2000))]
    pub(crate) description: String,
    /// The number of space dimensions, 2 or 3.
    #[schemars(range(min = 2, max = 3))]
    pub(crate) dimension: u8,
    /// A table of numbers that expressions refer to by name. Wherever a number of the scene stands, a text of
    /// parameters may stand, such as `"2*a"`.
    #[serde(default)]
    pub(crate) parameters: BTreeMap<String, Parameter>,
    /// The table of the settings of a run.
    #[serde(default)]
    pub(crate) step: Step,
    /// The table of the forces on every particle, `gravity` and `drag`; forces on single particles stand in
    /// `[[loads]]`.
    #[serde(default)]
    pub(crate) forces: Forces,
    /// The table of the feedback that keeps constraints near zero under integrators that do not project.
    #[serde(default)]
    pub(crate) feedback: Feedback,
    /// The list of the particles.
    #[serde(default)]
    pub(crate) particles: Vec<Particle>,
    /// The list of the constraints, which hold exactly.
    #[serde(default)]
    pub(crate) constraints: Vec<Constraint>,
    /// The list of the springs.
    #[serde(default)]
    pub(crate) springs: Vec<Spring>,
    /// The list of the forces beside gravity, drag and springs.
    #[serde(default)]
    pub(crate) loads: Vec<Load>,
    /// The list of blocks of many particles with their links, such as chains and nets.
    #[serde(default)]
    pub(crate) generate: Vec<Generate>,
    /// The list of the rigid bodies, each made of particles and rods.
    #[serde(default)]
    pub(crate) bodies: Vec<body::Body>,
    /// The table of the results that the scene must show.
    #[serde(default)]
    pub(crate) expect: Option<Expect>,
}

/// The version of the format.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
pub(crate) enum Version {
    /// The first version.
    #[serde(rename = "qhat/1")]
    One,
}

/// A point mass.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Particle {
    /// The name by which other tables refer to the particle.
    pub(crate) id: Id,
    /// The position at the start [m].
    pub(crate) at: Vector,
    /// The mass [kg], above 0.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The velocity at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// Whether the particle stays at its position.
    #[serde(default)]
    pub(crate) fixed: bool,
}

pub(crate) fn one() -> f64 {
    1.0
}
