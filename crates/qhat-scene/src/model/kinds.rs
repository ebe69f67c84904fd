//! The kinds of `[[constraints]]` beyond rods and nails.

use super::driven::{Driven, DrivenVector};
use super::{Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Two particles at one place.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Coincidence {
    /// Its name in reports; `coincidence(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
}

/// A particle in the middle of two others.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Midpoint {
    /// Its name in reports; `midpoint(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle in the middle.
    pub(crate) particle: Id,
    /// The ids of the two others.
    pub(crate) between: [Id; 2],
}

/// The centre of mass of particles at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CenterOfMass {
    /// Its name in reports; `center-of-mass(first)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once.
    #[schemars(length(min = 1))]
    pub(crate) particles: Vec<Id>,
    /// The point where it is [m], numbers or expressions of t; where it starts if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
}

/// A sum of places, each times a weight, at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Relation {
    /// Its name in reports; `relation(first)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The particles with their weights, each particle once.
    #[schemars(length(min = 1))]
    pub(crate) terms: Vec<Term>,
    /// What the sum is [m], numbers or expressions of t; what it is at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
}

/// A particle with its weight.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Term {
    /// The id of the particle.
    pub(crate) particle: Id,
    /// What its place is multiplied by; not 0.
    pub(crate) weight: f64,
}

/// The line from one particle to another keeps a direction.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Direction {
    /// Its name in reports; `direction(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
    /// The direction, of any length, numbers or expressions of t; as they start if left out.
    #[serde(default)]
    pub(crate) along: Option<DrivenVector>,
}

/// A particle on a line: along a direction, or through two other particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Line {
    /// Its name in reports; `line(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The ids of two particles that the line goes through, in the place of `at` and `along`.
    #[serde(default)]
    pub(crate) between: Option<[Id; 2]>,
    /// A point of the line [m], numbers or expressions of t; where the particle starts if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// Its direction, of any length, numbers or expressions of t.
    #[serde(default)]
    pub(crate) along: Option<DrivenVector>,
}

/// A particle on a plane, in three dimensions: across a normal, or through three other particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plane {
    /// Its name in reports; `plane(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The ids of three particles that the plane goes through, in the place of `at` and `normal`.
    #[serde(default)]
    pub(crate) through: Option<[Id; 3]>,
    /// A point of the plane [m], numbers or expressions of t; where the particle starts if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// What it is at right angles to, of any length, numbers or expressions of t.
    #[serde(default)]
    pub(crate) normal: Option<DrivenVector>,
}

/// A particle on a sphere, in two dimensions a circle, about a point or another particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sphere {
    /// Its name in reports; `sphere(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The id of the particle in the centre, in the place of `center`.
    #[serde(default)]
    pub(crate) around: Option<Id>,
    /// The centre [m], numbers or expressions of t.
    #[serde(default)]
    pub(crate) center: Option<DrivenVector>,
    /// Its radius [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<Driven>,
}

/// A particle on a circle about a point or another particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Circle {
    /// Its name in reports; `circle(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The id of the particle in the centre, in the place of `center`.
    #[serde(default)]
    pub(crate) around: Option<Id>,
    /// The centre [m], numbers or expressions of t.
    #[serde(default)]
    pub(crate) center: Option<DrivenVector>,
    /// What it is at right angles to, of any length; in three dimensions only, and there it must be given.
    #[serde(default)]
    pub(crate) axis: Option<Vector>,
    /// Its radius [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<Driven>,
}

/// A bead on a wire: a particle on a smooth curve, which expressions of s or points give.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Curve {
    /// Its name in reports; `curve(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The coordinates of the curve [m], an expression of its parameter s for each dimension.
    #[serde(default)]
    #[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))]
    pub(crate) path: Option<Vec<String>>,
    /// The values of s at its two ends; the curve goes on beyond them as the expressions do.
    #[serde(default)]
    pub(crate) range: Option<[f64; 2]>,
    /// Points that the wire goes through smoothly, or with a `radius` straight from each to the next [m]; in the place of `path` and `range`.
    #[serde(default)]
    pub(crate) points: Option<Vec<Vector>>,
    /// The radius of the corners [m], above 0, of a wire that goes straight from point to point; a smooth curve if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<f64>,
    /// Whether the wire through points comes back to the first of them.
    #[serde(default)]
    pub(crate) closed: bool,
}
