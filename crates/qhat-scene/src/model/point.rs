//! `[[loads]]` on one particle or on a pair: constant and harmonic forces, actuators.

use super::{Id, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A constant force on one particle.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Point {
    /// The id of the particle that the force acts on.
    pub(crate) particle: Id,
    /// The force [N].
    pub(crate) force: Vector,
}

/// A harmonic force on one particle: force · cos(angular_frequency · t + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Harmonic {
    /// The id of the particle that the force acts on.
    pub(crate) particle: Id,
    /// The amplitude of the force [N].
    pub(crate) force: Vector,
    /// The angular frequency [rad/s].
    pub(crate) angular_frequency: f64,
    /// The phase at t = 0 [rad].
    #[serde(default)]
    pub(crate) phase: f64,
}

/// A push along the line between two particles: push + amplitude · cos(angular_frequency · t + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Actuator {
    /// The ids of the two particles at the ends of the actuator.
    pub(crate) between: [Id; 2],
    /// The constant part of the push [N], positive where the actuator pushes its ends apart.
    #[serde(default)]
    pub(crate) push: f64,
    /// The amplitude of the harmonic part [N].
    #[serde(default)]
    pub(crate) amplitude: f64,
    /// The angular frequency of the harmonic part [rad/s].
    #[serde(default)]
    pub(crate) angular_frequency: f64,
    /// The phase of the harmonic part at t = 0 [rad].
    #[serde(default)]
    pub(crate) phase: f64,
}
