//! `[expect]`: what a scene must show. The tests of this crate run every shipped scene and hold it to this.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a scene must show when it is run as the file says.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// The degrees of freedom at the start: coordinates of free particles, less the rank of the constraints.
    pub degrees_of_freedom: Option<usize>,
    /// The rows at the start that repeat what others say: rows less rank, the states of self-stress.
    pub redundant_rows: Option<usize>,
    /// The most that a rod may be off its length, relative to it, in 60 s or the duration if that is longer; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_relative_length_error: Option<f64>,
    /// The most that may be missing in the balance of energy over the duration, relative to the largest kinetic energy; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub energy_error: Option<f64>,
    /// The most that a rigid row may be off at any frame of the duration, relative to its own scale (a rod's length); above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_residual: Option<f64>,
    /// Whether kinetic and potential energy together never rise from one frame to the next.
    pub energy_never_rises: bool,
    /// The period of a swing.
    pub period: Option<Period>,
    /// Where particles go.
    pub motion: Vec<Motion>,
    /// The tension of rods at the end of the duration.
    pub tension: Vec<Tension>,
    /// Where particles are at the end of the duration.
    pub at_end: Vec<AtEnd>,
    /// How fast particles are at the end of the duration.
    pub speed_at_end: Vec<SpeedAtEnd>,
    /// The names of all constraints that are broken at the end of the duration; an empty list says that nothing breaks.
    pub broken: Option<Vec<String>>,
}

/// The period of a swing: the mean time from one upward crossing of a coordinate's level to the next.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Period {
    /// The id of the particle that is watched.
    pub particle: String,
    /// The coordinate that is watched.
    pub axis: Axis,
    /// The level that it crosses [m].
    #[serde(default)]
    pub level: f64,
    /// The period [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub value: f64,
    /// How far off it may be, relative to the value; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// Where a coordinate of a particle goes during the run.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// The id of the particle that is watched.
    pub particle: String,
    /// The coordinate that is watched.
    pub axis: Axis,
    /// The range that it never leaves [m].
    #[serde(default)]
    pub within: Option<[f64; 2]>,
    /// The range that it covers: it comes to or beyond both ends [m].
    #[serde(default)]
    pub covers: Option<[f64; 2]>,
}

/// The tension of a rod at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Tension {
    /// The name of the rod.
    pub rod: String,
    /// Its tension [N]: positive where it pulls its ends together.
    pub value: f64,
    /// How far off it may be [N], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// A coordinate of a particle at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct AtEnd {
    /// The id of the particle that is watched.
    pub particle: String,
    /// The coordinate that is watched.
    pub axis: Axis,
    /// Where it is [m].
    pub value: f64,
    /// How far off it may be [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// The speed of a particle at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedAtEnd {
    /// The id of the particle that is watched.
    pub particle: String,
    /// Its speed [m/s], 0 or more.
    #[schemars(range(min = 0.0))]
    pub value: f64,
    /// How far off it may be [m/s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// A coordinate.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third, in three dimensions.
    Z,
}

impl Axis {
    /// Its place among the coordinates of a particle.
    pub fn index(self) -> usize {
        self as usize
    }
}
