//! `[expect]`: the results that a scene must show. The tests of this crate run every shipped scene and check them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The results that a scene must show when it runs with its own settings.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Expect {
    /// The degrees of freedom at the start: coordinates of free particles, less the rank of the constraints.
    pub degrees_of_freedom: Option<usize>,
    /// The redundant rows at the start: rows less rank, the states of self-stress.
    pub redundant_rows: Option<usize>,
    /// The largest error of a rod's length, relative to the length, in 60 s or the duration if that is longer; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_relative_length_error: Option<f64>,
    /// The largest energy error over the duration, relative to the largest kinetic energy; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub energy_error: Option<f64>,
    /// The largest residual of a rigid row at any frame of the duration, relative to the scale of the row (a rod's
    /// length); above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub max_residual: Option<f64>,
    /// Whether kinetic and potential energy together never rise from one frame to the next.
    pub energy_never_rises: bool,
    /// The period of a swing.
    pub period: Option<Period>,
    /// The ranges of coordinates during the run.
    pub motion: Vec<Motion>,
    /// The tension of rods at the end of the duration.
    pub tension: Vec<Tension>,
    /// The positions of particles at the end of the duration.
    pub at_end: Vec<AtEnd>,
    /// The speeds of particles at the end of the duration.
    pub speed_at_end: Vec<SpeedAtEnd>,
    /// The names of all constraints that are broken at the end of the duration; an empty list says that none breaks.
    pub broken: Option<Vec<String>>,
}

/// The period of a swing: the mean time from one upward crossing of a coordinate's level to the next.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Period {
    /// The id of the particle.
    pub particle: String,
    /// The coordinate of the particle.
    pub axis: Axis,
    /// The level that the coordinate crosses [m].
    #[serde(default)]
    pub level: f64,
    /// The period [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub value: f64,
    /// The largest error allowed, relative to the value; above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// The range of a coordinate of a particle during the run.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// The id of the particle.
    pub particle: String,
    /// The coordinate of the particle.
    pub axis: Axis,
    /// The range that the coordinate never leaves [m].
    #[serde(default)]
    pub within: Option<[f64; 2]>,
    /// The range that the coordinate covers [m]: it reaches or passes both ends.
    #[serde(default)]
    pub covers: Option<[f64; 2]>,
}

/// The tension of a rod at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Tension {
    /// The name of the rod.
    pub rod: String,
    /// The tension [N], positive where the rod pulls its ends together.
    pub value: f64,
    /// The largest error allowed [N], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// A coordinate of a particle at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct AtEnd {
    /// The id of the particle.
    pub particle: String,
    /// The coordinate of the particle.
    pub axis: Axis,
    /// The value of the coordinate [m].
    pub value: f64,
    /// The largest error allowed [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// The speed of a particle at the end.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedAtEnd {
    /// The id of the particle.
    pub particle: String,
    /// The speed [m/s], 0 or more.
    #[schemars(range(min = 0.0))]
    pub value: f64,
    /// The largest error allowed [m/s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tolerance: f64,
}

/// An axis, by which a coordinate is chosen.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis, in three dimensions.
    Z,
}

impl Axis {
    /// The index of the coordinate among those of a particle: 0, 1 or 2.
    pub fn index(self) -> usize {
        self as usize
    }
}
