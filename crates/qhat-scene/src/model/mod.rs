//! The scene file as Rust types: the one list of its keys. The JSON Schema is made from them, the checker follows that
//! schema, and serde fills them. The first sentence on a key is what help and schema say about it.

pub(crate) mod body;
mod constraint;
pub(crate) mod contact;
mod content;
mod driven;
mod expect;
mod expression;
pub(crate) mod generate;
pub(crate) mod kinds;
mod linkage;
pub(crate) mod load;
mod step;
mod value;

pub(crate) use constraint::{Constraint, Distance, DistanceForm, Nail, NailForm, Spring};
pub(crate) use content::{Area, Volume};
pub(crate) use driven::{Driven, DrivenVector};
pub use expect::{AtEnd, Axis, Expect, Motion, Period, SpeedAtEnd, Tension};
pub(crate) use expression::{ExpressionConstraint, ExpressionForce, ExpressionPotential, Parameters, Residual};
pub(crate) use generate::Generate;
pub(crate) use linkage::{Angle, Gears, LengthRatio, Pulley, Rack, Rigid};
pub(crate) use step::{Feedback, Forces, Step};
pub(crate) use value::{Id, Name, PATTERNS, Vector};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene of qhat: particles, what holds them, what acts on them, and how to step. SI units.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
#[schemars(title = "qhat scene")]
pub(crate) struct Document {
    /// The version of the format.
    pub(crate) schema: Version,
    /// The title people see.
    #[schemars(length(min = 1, max = 100))]
    pub(crate) name: String,
    /// One or two sentences that say what there is to see.
    #[serde(default)]
    #[schemars(length(max = 2000))]
    pub(crate) description: String,
    /// The number of space dimensions, 2 or 3.
    #[schemars(range(min = 2, max = 3))]
    pub(crate) dimension: u8,
    /// A table of numbers that every expression of the scene may refer to by name.
    #[serde(default)]
    pub(crate) parameters: Parameters,
    /// How to step.
    #[serde(default)]
    pub(crate) step: Step,
    /// What acts on every particle.
    #[serde(default)]
    pub(crate) forces: Forces,
    /// What holds the constraints under the integrators that do not project.
    #[serde(default)]
    pub(crate) feedback: Feedback,
    /// The particles.
    #[serde(default)]
    pub(crate) particles: Vec<Particle>,
    /// The constraints, which hold exactly.
    #[serde(default)]
    pub(crate) constraints: Vec<Constraint>,
    /// The springs, which give.
    #[serde(default)]
    pub(crate) springs: Vec<Spring>,
    /// Forces beside gravity, drag and springs.
    #[serde(default)]
    pub(crate) loads: Vec<load::Load>,
    /// Particles by the dozen, with what connects them.
    #[serde(default)]
    pub(crate) generate: Vec<Generate>,
    /// Rigid bodies of particles and rods.
    #[serde(default)]
    pub(crate) bodies: Vec<body::Body>,
    /// What the scene must show; a test holds it to that.
    #[serde(default)]
    pub(crate) expect: Option<Expect>,
}

/// The version of the format.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
pub(crate) enum Version {
    /// The first.
    #[serde(rename = "qhat/1")]
    One,
}

/// A point mass.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Particle {
    /// The name by which others refer to it.
    pub(crate) id: Id,
    /// Where it starts [m].
    pub(crate) at: Vector,
    /// Its mass [kg], above 0.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// Its velocity at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// Whether it is held where it starts.
    #[serde(default)]
    pub(crate) fixed: bool,
}

pub(crate) fn one() -> f64 {
    1.0
}
