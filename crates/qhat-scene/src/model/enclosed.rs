//! `[[constraints]]` that hold an enclosed area or volume.

use super::constraint::named;
use super::{Driven, Id, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A polygon that keeps its area, in the plane.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Area {
    /// The name of the constraint in reports; `area(a)` after the first corner if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the corners in order, three or more.
    #[schemars(length(min = 3))]
    pub(crate) corners: Vec<Id>,
    /// The area [m²], positive where the corners run counterclockwise, or an expression of t; the area at the start if
    /// left out.
    #[serde(default)]
    pub(crate) area: Option<Driven>,
}

named!(Area, it => format!("area({})", it.corners[0].0));

/// A closed surface that keeps its volume, in space.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Volume {
    /// The name of the constraint in reports; `volume(a)` after the first corner if left out.
    #[serde(default)]
    pub(crate) id: Option<Name>,
    /// The ids of the corners of each face, counterclockwise as seen from outside; four faces or more, closed.
    #[schemars(length(min = 4))]
    pub(crate) faces: Vec<[Id; 3]>,
    /// The volume [m³], or an expression of t; the volume at the start if left out.
    #[serde(default)]
    pub(crate) volume: Option<Driven>,
}

named!(Volume, it => format!("volume({})", it.faces[0][0].0));
