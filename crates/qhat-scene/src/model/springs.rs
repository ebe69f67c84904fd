//! `[[springs]]`, and the springs of `[[loads]]`.

use super::Id;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A damped spring between two particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Spring {
    /// The ids of the two particles at the ends of the spring.
    pub(crate) between: [Id; 2],
    /// The stiffness of the spring [N/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// The damping of the spring [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The length at which the spring does not pull [m], 0 or more; the distance at the start if left out.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) rest: Option<f64>,
}

/// A damped spring that pulls with stiffness · x + cubic · x³ when it is longer than its rest length by x.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CubicSpring {
    /// The ids of the two particles at the ends of the spring.
    pub(crate) between: [Id; 2],
    /// The stiffness of the spring at rest [N/m], of either sign.
    pub(crate) stiffness: f64,
    /// The cubic stiffness of the spring [N/m³], of either sign.
    pub(crate) cubic: f64,
    /// The damping of the spring [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The length at which x is 0 [m], 0 or more; the distance at the start if left out.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) rest: Option<f64>,
}

/// A damped torsion spring at a hinge between two arms.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TorsionSpring {
    /// The ids of three particles: the end of one arm, the hinge, the end of the other arm.
    pub(crate) arms: [Id; 3],
    /// The stiffness of the spring [N·m/rad], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// The damping of the spring [N·m·s/rad], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The angle from the first arm to the second at which the spring exerts no torque [rad], at most π, which is
    /// straight: counterclockwise in the plane, 0 or more in space; the angle at the start if left out.
    #[serde(default)]
    #[schemars(range(min = -PI, max = PI))]
    pub(crate) angle: Option<f64>,
}
