//! `[[constraints]]` of mechanisms: pulleys, lengths in a ratio, angles and motors, gears, racks, rigid clusters.

use super::{Driven, Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope over several particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pulley {
    /// Its name in reports; `pulley(a-b)` after the first and the last particle if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles it goes over, two or more, in order; a particle that it passes several times is named as often.
    #[schemars(length(min = 2))]
    pub(crate) over: Vec<Id>,
    /// How many times each stretch between two of them counts, one number less than there are particles; 1 each if left out.
    #[serde(default)]
    pub(crate) weights: Option<Vec<f64>>,
    /// The length of the rope [m], above 0, or an expression of t; its length at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<Driven>,
}

/// Two distances in a ratio.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LengthRatio {
    /// Its name in reports; `ratio(a-b)` after the first pair if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles of one distance.
    pub(crate) between: [Id; 2],
    /// The ids of the two particles of the other distance.
    pub(crate) of: [Id; 2],
    /// How many times the other distance the one is, above 0; 1 keeps them equal; as at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) ratio: Option<f64>,
}

/// The angle at which an arm stands.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Angle {
    /// Its name in reports; `angle(a-b)` after the arm if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles where the arm begins and ends.
    pub(crate) arm: [Id; 2],
    /// The ids of the particles where the arm begins and ends from which the angle is counted.
    #[serde(default)]
    pub(crate) from: Option<[Id; 2]>,
    /// The direction from which the angle is counted where no arm is given; the x axis if left out.
    #[serde(default)]
    pub(crate) direction: Option<Vector>,
    /// The angle [rad], counterclockwise in the plane and between 0 and π in space, or an expression of t; the angle at the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

/// Two wheels that mesh, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gears {
    /// Its name in reports; `gears(a-b)` after the two centres if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// For each wheel the ids of its centre and of another of its particles.
    pub(crate) wheels: [[Id; 2]; 2],
    /// How many teeth each wheel has; one of the numbers below 0 where one wheel lies inside the other, or a belt connects them.
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub(crate) teeth: [i32; 2],
    /// Where they mesh [rad], or an expression of t; as at the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

/// A rack and its pinion, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rack {
    /// Its name in reports; `rack(a)` after its particle if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of a particle of the rack.
    pub(crate) particle: Id,
    /// The direction in which the rack moves, with the pinion to the left of it.
    pub(crate) along: Vector,
    /// The ids of the centre of the pinion and of another of its particles.
    pub(crate) pinion: [Id; 2],
    /// The radius of the pinion [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: f64,
    /// Where they mesh [rad], or an expression of t; as at the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

/// Particles that keep all their distances.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rigid {
    /// The ids of the particles that keep their distances, two or more.
    #[schemars(length(min = 2))]
    pub(crate) particles: Vec<Id>,
}
