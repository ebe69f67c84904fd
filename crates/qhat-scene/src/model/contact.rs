//! `[[constraints]]` that act on one side: ropes, limits, and what particles stay out of, or within.

use super::{Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope: slack up to its length, and then it does not stretch.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rope {
    /// Its name in reports; `rope(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles at its ends.
    pub(crate) between: [Id; 2],
    /// Its length [m], above 0; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<f64>,
    /// The part of the closing speed that comes back where it jerks taut, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The tension at which it breaks [N], above 0; none if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
}

/// A distance between two limits, or with one of them.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Limits {
    /// Its name in reports; `limits(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
    /// How near they may come [m], above 0; as near as they like if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) shortest: Option<f64>,
    /// How far apart they may go [m], above 0; as far as they like if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) longest: Option<f64>,
    /// The part of the closing speed that comes back where a limit is hit, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The tension or thrust at which it breaks [N], above 0; none if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
}

/// Particles on one side of a straight line or plane: ground, a wall, a slope.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HalfSpace {
    /// Its name in reports, with the particle in brackets behind it; `half-space` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// The direction into the side where they stay, of any length; upwards, along y, if left out.
    #[serde(default)]
    pub(crate) normal: Option<Vector>,
    /// A point of the line or plane [m]; the origin if left out.
    #[serde(default)]
    pub(crate) through: Option<Vector>,
    /// The part of the closing speed that an impact gives back, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}

/// Particles outside of a circle or sphere, or inside.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ball {
    /// Its name in reports, with the particle in brackets behind it; `ball` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// Its centre [m].
    pub(crate) center: Vector,
    /// Its radius [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: f64,
    /// Whether the particles stay inside.
    #[serde(default)]
    pub(crate) inside: bool,
    /// The part of the closing speed that an impact gives back, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}

/// Particles outside of a box along the axes.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Box {
    /// Its name in reports, with the particle in brackets behind it; `box` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// Its centre [m].
    pub(crate) center: Vector,
    /// Its size along each axis [m], above 0.
    pub(crate) size: Vector,
    /// The part of the closing speed that an impact gives back, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}
