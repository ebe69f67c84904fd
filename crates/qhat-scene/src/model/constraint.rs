//! `[[constraints]]` and `[[springs]]`.

use super::contact::{Ball, Box, HalfSpace, Limits, Rope};
use super::content::{Area, Volume};
use super::kinds::{CenterOfMass, Circle, Coincidence, Curve, Direction, Line, Midpoint, Plane, Relation, Sphere};
use super::linkage::{Angle, Gears, LengthRatio, Pulley, Rack, Rigid};
use super::{Driven, DrivenVector, ExpressionConstraint, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What holds exactly.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(crate) enum Constraint {
    Distance(Distance),
    Nail(Nail),
    Expression(ExpressionConstraint),
    Pulley(Pulley),
    LengthRatio(LengthRatio),
    Angle(Angle),
    Gears(Gears),
    Rack(Rack),
    Rigid(Rigid),
    Area(Area),
    Volume(Volume),
    Coincidence(Coincidence),
    Midpoint(Midpoint),
    CenterOfMass(CenterOfMass),
    Relation(Relation),
    Direction(Direction),
    Line(Line),
    Plane(Plane),
    Sphere(Sphere),
    Circle(Circle),
    Curve(Curve),
    Rope(Rope),
    Limits(Limits),
    HalfSpace(HalfSpace),
    Ball(Ball),
    Box(Box),
}

impl Constraint {
    /// The name that the file gives it.
    pub(crate) fn id(&self) -> Option<&Name> {
        match self {
            Constraint::Distance(it) => it.id.as_ref(),
            Constraint::Nail(it) => it.id.as_ref(),
            Constraint::Coincidence(it) => it.id.as_ref(),
            Constraint::Midpoint(it) => it.id.as_ref(),
            Constraint::CenterOfMass(it) => it.id.as_ref(),
            Constraint::Relation(it) => it.id.as_ref(),
            Constraint::Direction(it) => it.id.as_ref(),
            Constraint::Line(it) => it.id.as_ref(),
            Constraint::Plane(it) => it.id.as_ref(),
            Constraint::Sphere(it) => it.id.as_ref(),
            Constraint::Circle(it) => it.id.as_ref(),
            Constraint::Curve(it) => it.id.as_ref(),
            Constraint::Expression(it) => it.id.as_ref(),
            Constraint::Pulley(it) => it.id.as_ref(),
            Constraint::LengthRatio(it) => it.id.as_ref(),
            Constraint::Angle(it) => it.id.as_ref(),
            Constraint::Gears(it) => it.id.as_ref(),
            Constraint::Rack(it) => it.id.as_ref(),
            Constraint::Area(it) => it.id.as_ref(),
            Constraint::Volume(it) => it.id.as_ref(),
            Constraint::Rope(it) => it.id.as_ref(),
            Constraint::Limits(it) => it.id.as_ref(),
            Constraint::HalfSpace(it) => it.id.as_ref(),
            Constraint::Ball(it) => it.id.as_ref(),
            Constraint::Box(it) => it.id.as_ref(),
            Constraint::Rigid(_) => None,
        }
    }
}

/// A rod: two particles stay as far apart as they are.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Distance {
    /// Its name in reports; the ids of its ends with a `-` between them if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles at its ends.
    pub(crate) between: [Id; 2],
    /// Its length [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<Driven>,
    /// The function that is held at zero: the length's error, or that of its square (the classic one).
    #[serde(default)]
    pub(crate) form: DistanceForm,
    /// How far it gives way [m/N], 0 (rigid) or more: under a tension T it is longer by this times T.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) compliance: f64,
    /// A damper beside the compliance [N·s/m], 0 or more; a rigid rod has no motion to damp.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The tension or thrust at which it breaks [N], above 0; none if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
}

/// The function of a distance that is held at zero.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum DistanceForm {
    /// |d| − r.
    #[default]
    Length,
    /// d·d − r².
    Squared,
}

impl From<DistanceForm> for qhat::DistanceForm {
    fn from(form: DistanceForm) -> Self {
        match form {
            DistanceForm::Length => qhat::DistanceForm::Length,
            DistanceForm::Squared => qhat::DistanceForm::Squared,
        }
    }
}

/// A nail: one particle stays at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nail {
    /// Its name in reports; `nail(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle it holds.
    pub(crate) particle: Id,
    /// The point where it is [m], numbers or expressions of t; where the particle starts if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// The function that is held at zero: the offset itself, or its square (the classic one).
    #[serde(default)]
    pub(crate) form: NailForm,
}

/// The function of the offset x − p that is held at zero.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum NailForm {
    /// x − p, one row for each dimension.
    #[default]
    Vector,
    /// |x − p|², one row whose gradient vanishes where it holds.
    Scalar,
}

impl From<NailForm> for qhat::NailForm {
    fn from(form: NailForm) -> Self {
        match form {
            NailForm::Vector => qhat::NailForm::Vector,
            NailForm::Scalar => qhat::NailForm::Scalar,
        }
    }
}

/// A damped spring between two particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Spring {
    /// The ids of the two particles at its ends.
    pub(crate) between: [Id; 2],
    /// Its stiffness [N/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) stiffness: f64,
    /// Its damping [N·s/m], 0 or more.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The length at which it does not pull [m], 0 or more; the distance at the start if left out.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) rest: Option<f64>,
}
