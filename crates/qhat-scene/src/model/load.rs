//! `[[loads]]`: every force that is neither gravity or drag on all particles nor a plain spring.

use super::{ExpressionForce, ExpressionPotential, Id, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A force.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Load {
    Point(Point),
    Harmonic(Harmonic),
    Actuator(Actuator),
    CubicSpring(CubicSpring),
    TorsionSpring(TorsionSpring),
    CentralGravity(CentralGravity),
    PairwiseGravity(PairwiseGravity),
    Charges(Charges),
    AirDrag(AirDrag),
    Pressure(Pressure),
    Force(ExpressionForce),
    Potential(ExpressionPotential),
}

/// A constant force on one particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Point {
    /// The id of the particle it acts on.
    pub(crate) particle: Id,
    /// The force [N].
    pub(crate) force: Vector,
}

/// A force on one particle that swings with time: force · cos(angular_frequency · t + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Harmonic {
    /// The id of the particle it acts on.
    pub(crate) particle: Id,
    /// The force where it is largest [N].
    pub(crate) force: Vector,
    /// How fast it swings [rad/s].
    pub(crate) angular_frequency: f64,
    /// Where it starts in its swing [rad].
    #[serde(default)]
    pub(crate) phase: f64,
}

/// A push along the line between two particles: push + amplitude · cos(angular_frequency · t + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Actuator {
    /// The ids of the two particles at its ends.
    pub(crate) between: [Id; 2],
    /// The constant part [N], positive where it pushes its ends apart.
    #[serde(default)]
    pub(crate) push: f64,
    /// The part that swings [N].
    #[serde(default)]
    pub(crate) amplitude: f64,
    /// How fast it swings [rad/s].
    #[serde(default)]
    pub(crate) angular_frequency: f64,
    /// Where it starts in its swing [rad].
    #[serde(default)]
    pub(crate) phase: f64,
}

/// A damped spring that pulls with stiffness · x + cubic · x³ when it is longer than its rest length by x.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CubicSpring {
    /// The ids of the two particles at its ends.
    pub(crate) between: [Id; 2],
    /// Its stiffness at rest [N/m], of either sign.
    pub(crate) stiffness: f64,
    /// Its cubic stiffness [N/m³], of either sign.
    pub(crate) cubic: f64,
    /// Its damping [N·s/m], 0 or more.
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
    /// Its stiffness [N·m/rad], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// Its damping [N·m·s/rad], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The angle from the first arm to the second at which it does not turn them [rad], at most π, which is straight: counter-clockwise in the plane, 0 or more in space; the angle at the start if left out.
    #[serde(default)]
    #[schemars(range(min = -PI, max = PI))]
    pub(crate) angle: Option<f64>,
}

/// Gravity towards a point that does not move.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CentralGravity {
    /// The ids of the particles it acts on; all that are not fixed if left out.
    #[serde(default)]
    pub(crate) particles: Option<Vec<Id>>,
    /// The point [m].
    pub(crate) center: Vector,
    /// The gravitational constant times the mass at the point [m³/s²].
    pub(crate) mu: f64,
    /// The softening length [m], 0 or more: the distance below which the force no longer grows.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) softening: f64,
}

/// Gravity between every two of some particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PairwiseGravity {
    /// The ids of 2 to 100 particles.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) particles: Vec<Id>,
    /// The gravitational constant [m³/(kg·s²)]; that of nature if left out.
    #[serde(default = "newton")]
    pub(crate) constant: f64,
    /// The softening length [m], 0 or more: the distance below which the force no longer grows.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) softening: f64,
}

/// Electrostatics between every two of some particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Charges {
    /// The ids of 2 to 100 particles.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) particles: Vec<Id>,
    /// Their charges [C], one for each particle.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) charges: Vec<f64>,
    /// Coulomb's constant [N·m²/C²]; that of empty space if left out.
    #[serde(default = "coulomb")]
    pub(crate) constant: f64,
    /// The softening length [m], 0 or more: the distance below which the force no longer grows.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) softening: f64,
}

/// Drag in air that may move: −(linear + quadratic · |u|) u at the velocity u relative to the wind.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct AirDrag {
    /// The ids of the particles it acts on; all that are not fixed if left out.
    #[serde(default)]
    pub(crate) particles: Option<Vec<Id>>,
    /// The linear coefficient of each particle [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) linear: f64,
    /// The quadratic coefficient of each particle [N·s²/m²], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) quadratic: f64,
    /// The wind at the origin [m/s]; none if left out.
    #[serde(default)]
    pub(crate) wind: Option<Vector>,
    /// How the wind changes from place to place [1/s]: for each of its components the gradient, a vector; everywhere the same if left out.
    #[serde(default)]
    #[schemars(length(min = 2, max = 3))]
    pub(crate) gradient: Option<Vec<Vector>>,
}

/// A pressure inside a closed loop in the plane, or a closed mesh of triangles in space.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pressure {
    /// The pressure [N/m in the plane, Pa in space], positive where it pushes outward; at the start, where `exponent` is given.
    pub(crate) pressure: f64,
    /// The exponent of a gas, above 0, whose pressure times area or volume to this power stays: 1 at one temperature, 1.4 for air that exchanges no heat; the pressure stays if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) exponent: Option<f64>,
    /// The ids of the particles of the loop in either order, 3 or more; for the plane.
    #[serde(default)]
    pub(crate) outline: Vec<Id>,
    /// The ids at the corners of each triangle, counter-clockwise as seen from outside; for space.
    #[serde(default)]
    pub(crate) triangles: Vec<[Id; 3]>,
}

/// The gravitational constant (CODATA 2022).
fn newton() -> f64 {
    6.6743e-11
}

/// Coulomb's constant, 1/(4π ε₀) (CODATA 2022).
fn coulomb() -> f64 {
    8.987_551_786_2e9
}
