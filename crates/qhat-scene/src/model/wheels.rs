//! `[[constraints]]` of angles and motors, gears, racks.

use super::constraint::named;
use super::{Driven, Id, Name, Vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The angle of an arm, held or driven by a motor.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Angle {
    /// The name of the constraint in reports; `angle(a-b)` after the arm if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles at the beginning and the end of the arm.
    pub(crate) arm: [Id; 2],
    /// The ids of the particles at the beginning and the end of the arm from which the angle is counted.
    #[serde(default)]
    pub(crate) from: Option<[Id; 2]>,
    /// The direction from which the angle is counted where `from` is left out; the x axis if both are left out.
    #[serde(default)]
    pub(crate) direction: Option<Vector>,
    /// The angle [rad], counterclockwise in the plane and between 0 and π in space, or an expression of t; the angle at
    /// the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

named!(Angle, it => format!("angle({}-{})", it.arm[0].0, it.arm[1].0));

/// Two wheels that mesh, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Gears {
    /// The name of the constraint in reports; `gears(a-b)` after the two centres if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// For each wheel the ids of its centre and of another of its particles.
    pub(crate) wheels: [[Id; 2]; 2],
    /// The numbers of teeth of the two wheels; one of them is below 0 where one wheel lies inside the other, or a belt
    /// connects them.
    #[schemars(inner(range(min = -1000, max = 1000)))]
    pub(crate) teeth: [i32; 2],
    /// The angle at which the wheels mesh [rad], or an expression of t; the angle at the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

named!(Gears, it => format!("gears({}-{})", it.wheels[0][0].0, it.wheels[1][0].0));

/// A rack and its pinion, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rack {
    /// The name of the constraint in reports; `rack(a)` after the particle of the rack if left out.
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
    /// The angle at which rack and pinion mesh [rad], or an expression of t; the angle at the start if left out.
    #[serde(default)]
    pub(crate) angle: Option<Driven>,
}

named!(Rack, it => format!("rack({})", it.particle.0));
