//! `[[constraints]]` that act on one side: ropes, limits of a distance, and obstacles.

use super::constraint::named;
use super::{Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope: slack up to its length, rigid at its length.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rope {
    /// The name of the rope in reports; `rope(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles at the ends of the rope.
    pub(crate) between: [Id; 2],
    /// The length of the rope [m], above 0; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<f64>,
    /// The coefficient of restitution when the rope becomes taut, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The tension at which the rope breaks [N], above 0; the rope never breaks if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
    /// The impulse of a jerk or a blow at which the rope breaks [N·s], above 0; no impulse breaks it if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at_impulse: Option<f64>,
    /// EA of the rope [N], above 0, 1 if left out: how redundant ropes share a force. The motion does not depend on it.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) stiffness: Option<f64>,
}

named!(Rope, it => format!("rope({}-{})", it.between[0].0, it.between[1].0));

/// A distance between two limits, or with one limit.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Limits {
    /// The name of the constraint in reports; `limits(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
    /// The shortest distance allowed [m], above 0; no limit if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) shortest: Option<f64>,
    /// The longest distance allowed [m], above 0; no limit if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) longest: Option<f64>,
    /// The coefficient of restitution at a limit, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The tension or thrust at which the constraint breaks [N], above 0; the constraint never breaks if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
    /// The impulse of a jerk or a blow at which the constraint breaks [N·s], above 0; no impulse breaks it if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at_impulse: Option<f64>,
    /// EA [N], above 0, 1 if left out: how redundant links share a force. The motion does not depend on it.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) stiffness: Option<f64>,
}

named!(Limits, it => format!("limits({}-{})", it.between[0].0, it.between[1].0));

/// Particles on one side of a straight line or plane: ground, a wall, a slope.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HalfSpace {
    /// The name of the obstacle in reports, followed by the particle in brackets; `half-space` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all particles that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// The normal, a vector of any length into the side where the particles stay; upwards, along y, if left out.
    #[serde(default)]
    pub(crate) normal: Option<Vector>,
    /// A point of the line or plane [m]; the origin if left out.
    #[serde(default)]
    pub(crate) through: Option<Vector>,
    /// The coefficient of restitution of an impact, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}

named!(HalfSpace, _it => "half-space".to_owned());

/// Particles outside of a circle or sphere, or inside.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ball {
    /// The name of the obstacle in reports, followed by the particle in brackets; `ball` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all particles that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// The centre of the ball [m].
    pub(crate) center: Vector,
    /// The radius of the ball [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: f64,
    /// Whether the particles stay inside.
    #[serde(default)]
    pub(crate) inside: bool,
    /// The coefficient of restitution of an impact, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}

named!(Ball, _it => "ball".to_owned());

/// Particles outside of a box along the axes.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Box {
    /// The name of the obstacle in reports, followed by the particle in brackets; `box` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once; all particles that are not fixed if left out.
    #[serde(default)]
    #[schemars(length(min = 1))]
    pub(crate) particles: Option<Vec<Id>>,
    /// The centre of the box [m].
    pub(crate) center: Vector,
    /// The size of the box along each axis [m], above 0.
    pub(crate) size: Vector,
    /// The coefficient of restitution of an impact, 0 to 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub(crate) restitution: f64,
    /// The coefficient of Coulomb friction, 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) friction: f64,
}

named!(Box, _it => "box".to_owned());
