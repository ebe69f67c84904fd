//! `kind = "pressure"` of `[[loads]]`.

use super::Id;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A pressure inside a closed loop in the plane, or a closed mesh of triangles in space.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pressure {
    /// The pressure [N/m in the plane, Pa in space], positive where it pushes outward; the pressure at the start where
    /// `exponent` is given.
    pub(crate) pressure: f64,
    /// The exponent of a gas, above 0: pressure times area or volume to this power is constant, with 1 at constant
    /// temperature and 1.4 for air that exchanges no heat; the pressure is constant if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) exponent: Option<f64>,
    /// The ids of the particles of the loop in either order, 3 or more; for the plane.
    #[serde(default)]
    pub(crate) outline: Vec<Id>,
    /// The ids at the corners of each triangle, counterclockwise as seen from outside; for space.
    #[serde(default)]
    pub(crate) triangles: Vec<[Id; 3]>,
}
