//! `[[loads]]` of fields: gravity towards a point and between particles, electrostatics, drag in air.

use super::{Id, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gravity towards a point that does not move.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CentralGravity {
    /// The ids of the particles that the force acts on; all particles that are not fixed if left out.
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

/// Gravity between every two particles of a list.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PairwiseGravity {
    /// The ids of 2 to 100 particles.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) particles: Vec<Id>,
    /// The gravitational constant [m³/(kg·s²)]; the one of nature if left out.
    #[serde(default = "newton")]
    pub(crate) constant: f64,
    /// The softening length [m], 0 or more: the distance below which the force no longer grows.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) softening: f64,
}

/// Electrostatic forces between every two particles of a list.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Charges {
    /// The ids of 2 to 100 particles.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) particles: Vec<Id>,
    /// The charges of the particles [C], one for each particle.
    #[schemars(length(min = 2, max = 100))]
    pub(crate) charges: Vec<f64>,
    /// Coulomb's constant [N·m²/C²]; the one of empty space if left out.
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
    /// The ids of the particles that the drag acts on; all particles that are not fixed if left out.
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
    /// The gradient of the wind [1/s], a vector for each component of the wind; the wind is the same everywhere if left
    /// out.
    #[serde(default)]
    #[schemars(length(min = 2, max = 3))]
    pub(crate) gradient: Option<Vec<Vector>>,
}

/// The gravitational constant (CODATA 2022).
fn newton() -> f64 {
    6.6743e-11
}

/// Coulomb's constant, 1/(4π ε₀) (CODATA 2022).
fn coulomb() -> f64 {
    8.987_551_786_2e9
}
