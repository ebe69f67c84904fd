//! `[[constraints]]` between several lengths: ropes over pulleys and lengths in a ratio.

use super::constraint::named;
use super::{Driven, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rope over several particles.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pulley {
    /// The name of the rope in reports; `pulley(a-b)` after its first and last particle if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the particles that the rope goes over, two or more, in order; a particle that the rope passes several
    /// times is named as often.
    #[schemars(length(min = 2))]
    pub(crate) over: Vec<Id>,
    /// The weights of the stretches from one particle to the next, one number less than there are particles; 1 each if
    /// left out.
    #[serde(default)]
    pub(crate) weights: Option<Vec<f64>>,
    /// The length of the rope [m], above 0, or an expression of t; the length at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) length: Option<Driven>,
}

named!(Pulley, it => format!("pulley({}-{})", it.over[0].0, it.over[it.over.len() - 1].0));

/// Two distances in a ratio.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LengthRatio {
    /// The name of the constraint in reports; `ratio(a-b)` after the first pair if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the two particles of the first distance.
    pub(crate) between: [Id; 2],
    /// The ids of the two particles of the second distance.
    pub(crate) of: [Id; 2],
    /// The first distance divided by the second, above 0; the ratio at the start if left out.
    #[serde(default)]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) ratio: Option<f64>,
}

named!(LengthRatio, it => format!("ratio({}-{})", it.between[0].0, it.between[1].0));
