//! `[[constraints]]` of spheres, circles, ellipses and wires.

use super::constraint::named;
use super::{Driven, DrivenVector, Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A particle on a sphere, in two dimensions a circle, about a point or another particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sphere {
    /// The name of the constraint in reports; `sphere(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The id of the particle at the centre, in place of `center`.
    #[serde(default)]
    pub(crate) around: Option<Id>,
    /// The centre [m], numbers or expressions of t.
    #[serde(default)]
    pub(crate) center: Option<DrivenVector>,
    /// The radius [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<Driven>,
}

named!(Sphere, it => format!("sphere({})", it.particle.0));

/// A particle on a circle about a point or another particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Circle {
    /// The name of the constraint in reports; `circle(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The id of the particle at the centre, in place of `center`.
    #[serde(default)]
    pub(crate) around: Option<Id>,
    /// The centre [m], numbers or expressions of t.
    #[serde(default)]
    pub(crate) center: Option<DrivenVector>,
    /// The axis of the circle, a vector of any length at right angles to the circle; required in three dimensions,
    /// refused in two.
    #[serde(default)]
    pub(crate) axis: Option<Vector>,
    /// The radius [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<Driven>,
}

named!(Circle, it => format!("circle({})", it.particle.0));

/// A particle on an ellipse about a point or another particle, in two dimensions.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ellipse {
    /// The name of the constraint in reports; `ellipse(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The id of the particle at the centre, in place of `center`.
    #[serde(default)]
    pub(crate) around: Option<Id>,
    /// The centre [m], numbers or expressions of t.
    #[serde(default)]
    pub(crate) center: Option<DrivenVector>,
    /// The direction of the first axis, a vector of any length; the x axis if left out.
    #[serde(default)]
    pub(crate) along: Option<Vector>,
    /// Half the size of the ellipse along its first axis [m], a number above 0 or an expression of t.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) half_along: Driven,
    /// Half the size of the ellipse across its first axis [m], a number above 0 or an expression of t.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) half_across: Driven,
}

named!(Ellipse, it => format!("ellipse({})", it.particle.0));

/// A bead on a wire: a particle on a smooth curve, given by expressions of s or by points.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Curve {
    /// The name of the constraint in reports; `curve(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The coordinates of the curve [m], an expression of its parameter s for each dimension.
    #[serde(default)]
    #[schemars(length(min = 2, max = 3), extend("x-length" = "dimension"))]
    pub(crate) path: Option<Vec<String>>,
    /// The values of s at the two ends of the curve; beyond them the curve goes on as its expressions do.
    #[serde(default)]
    pub(crate) range: Option<[f64; 2]>,
    /// The points of the wire [m], in place of `path` and `range`: joined by a smooth curve, or with `radius` by
    /// straight pieces.
    #[serde(default)]
    pub(crate) points: Option<Vec<Vector>>,
    /// The radius of the corners of a wire of straight pieces [m], above 0; the wire is a smooth curve if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: Option<f64>,
    /// Whether the wire comes back to the first of its points.
    #[serde(default)]
    pub(crate) closed: bool,
}

named!(Curve, it => format!("curve({})", it.particle.0));
