//! `[[constraints]]` that hold sums of positions at a point: nails, coincidences, midpoints, centres of mass.

use super::constraint::named;
use super::{DrivenVector, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A nail: one particle stays at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nail {
    /// The name of the nail in reports; `nail(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle that the nail holds.
    pub(crate) particle: Id,
    /// The point of the nail [m], numbers or expressions of t; the position of the particle at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
    /// The function that is held at zero: the offset from the point, or its square (the classic form).
    #[serde(default)]
    pub(crate) form: NailForm,
}

named!(Nail, it => format!("nail({})", it.particle.0));

/// The function of the offset x − p that is held at zero.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum NailForm {
    /// x − p, one row for each dimension.
    #[default]
    Vector,
    /// |x − p|², one row whose gradient is zero where the constraint holds.
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

/// Two particles at one place.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Coincidence {
    /// The name of the constraint in reports; `coincidence(a-b)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles.
    pub(crate) between: [Id; 2],
}

named!(Coincidence, it => format!("coincidence({}-{})", it.between[0].0, it.between[1].0));

/// A particle in the middle of two others.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Midpoint {
    /// The name of the constraint in reports; `midpoint(particle)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The id of the particle in the middle.
    pub(crate) particle: Id,
    /// The ids of the two others.
    pub(crate) between: [Id; 2],
}

named!(Midpoint, it => format!("midpoint({})", it.particle.0));

/// The centre of mass of particles at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CenterOfMass {
    /// The name of the constraint in reports; `center-of-mass(first)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles, each once.
    #[schemars(length(min = 1))]
    pub(crate) particles: Vec<Id>,
    /// The point of the centre of mass [m], numbers or expressions of t; its position at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
}

named!(CenterOfMass, it => format!("center-of-mass({})", it.particles[0].0));

/// A sum of positions, each times a weight, at a point.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Relation {
    /// The name of the constraint in reports; `relation(first)` if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The particles with their weights, each particle once.
    #[schemars(length(min = 1))]
    pub(crate) terms: Vec<Term>,
    /// The value of the sum [m], numbers or expressions of t; its value at the start if left out.
    #[serde(default)]
    pub(crate) at: Option<DrivenVector>,
}

named!(Relation, it => format!("relation({})", it.terms[0].particle.0));

/// A particle with its weight.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Term {
    /// The id of the particle.
    pub(crate) particle: Id,
    /// The factor of its position in the sum, not 0.
    pub(crate) weight: f64,
}
