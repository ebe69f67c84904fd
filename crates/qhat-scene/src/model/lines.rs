//! `[[constraints]]` of directions, straight lines and planes.

use super::constraint::named;
use super::{DrivenVector, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The line from one particle to another keeps a direction.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Direction {
    /// The name of the constraint in reports; `direction(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
    /// The direction, a vector of any length, numbers or expressions of t; the direction at the start if left out.
    #[serde(default)]
    pub(crate) along: Option<DrivenVector>,
}

named!(Direction, it => format!("direction({}-{})", it.between[0].0, it.between[1].0));

/// A particle on a straight line: along a direction, or through two other particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Line {
    /// The name of the constraint in reports; `line(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The ids of two particles that the line goes through, in place of `at` and `along`.
    #[serde(default)]
    pub(crate) between: Option<[Id; 2]>,
    /// A point of the line [m], numbers or expressions of t; the position of the particle at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// The direction of the line, a vector of any length, numbers or expressions of t.
    #[serde(default)]
    pub(crate) along: Option<DrivenVector>,
}

named!(Line, it => format!("line({})", it.particle.0));

/// A particle on a plane, in three dimensions: across a normal, or through three other particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plane {
    /// The name of the constraint in reports; `plane(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The ids of three particles that the plane goes through, in place of `at` and `normal`.
    #[serde(default)]
    pub(crate) through: Option<[Id; 3]>,
    /// A point of the plane [m], numbers or expressions of t; the position of the particle at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// The normal of the plane, a vector of any length, numbers or expressions of t.
    #[serde(default)]
    pub(crate) normal: Option<DrivenVector>,
}

named!(Plane, it => format!("plane({})", it.particle.0));
