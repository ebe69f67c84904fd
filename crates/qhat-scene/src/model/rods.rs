//! `[[constraints]]` that hold distances: rods and rigid clusters.

use super::constraint::{Named, named};
use super::{Driven, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rod: two particles keep their distance.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Distance {
    /// The name of the rod in reports; the ids of its ends with a `-` between them if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles at the ends of the rod.
    pub(crate) between: [Id; 2],
    /// The length of the rod [m], a number above 0 or an expression of t; the distance at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<Driven>,
    /// The function that is held at zero: the error of the length, or of its square (the classic form).
    #[serde(default)]
    pub(crate) form: DistanceForm,
    /// The compliance of the rod [m/N], 0 (rigid) or more: under a tension T the rod is longer by compliance · T.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) compliance: f64,
    /// The damping beside the compliance [N·s/m], 0 or more; a rigid rod has no motion to damp.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub(crate) damping: f64,
    /// The tension or thrust at which the rod breaks [N], above 0; the rod never breaks if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at: Option<f64>,
    /// The impulse of a blow at which the rod breaks [N·s], above 0; no impulse breaks it if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) breaks_at_impulse: Option<f64>,
    /// EA of the rod [N], above 0, 1 if left out: how redundant rods share a force. The motion does not depend on it.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) stiffness: Option<f64>,
}

named!(Distance, it => format!("{}-{}", it.between[0].0, it.between[1].0));

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

/// A rigid cluster: particles keep all their distances.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Rigid {
    /// The ids of the particles that keep their distances, two or more.
    #[schemars(length(min = 2))]
    pub(crate) particles: Vec<Id>,
}

// A cluster has no `id`: its rods are named after their ends, and its default name stands in messages alone.
impl Named for Rigid {
    fn id(&self) -> Option<&Name> {
        None
    }

    fn default_name(&self) -> String {
        format!("rigid({})", self.particles[0].0)
    }
}
