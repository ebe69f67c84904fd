//! `[step]`, `[forces]` and `[feedback]`. The defaults are the engine's own.

use super::Vector;
use qhat::{Integrator, Settings};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::borrow::Cow;

/// How to step.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Step {
    /// The step of a fixed-step integrator, the frame of an adaptive one [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) h: f64,
    /// How the state is carried over a step.
    pub(crate) integrator: Method,
    /// The relative error of a substep that adaptive integrators aim at, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub(crate) tolerance: f64,
    /// The |C| that a projection leaves, relative to the row's own length, from 1e-14 to 1e-2.
    #[schemars(range(min = 1e-14, max = 1e-2))]
    pub(crate) constraint_tolerance: f64,
    /// Newton iterations that implicit and bdf2 may take a frame, 1 or more; what was not reached is reported.
    #[schemars(range(min = 1))]
    pub(crate) frame_budget: u32,
    /// Row solves that auto may take a frame before it goes over to bdf2, 1 or more.
    #[schemars(range(min = 1))]
    pub(crate) frame_work: u32,
    /// How long a run of the scene is [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) duration: f64,
}

impl Default for Step {
    fn default() -> Self {
        let Settings { h, integrator, tolerance, constraint_tolerance, frame_budget, frame_work, .. } =
            Settings::default();
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        let (frame_budget, frame_work) = (count(frame_budget), count(frame_work));
        let integrator = Method(integrator);
        Step { h, integrator, tolerance, constraint_tolerance, frame_budget, frame_work, duration: 10.0 }
    }
}

/// An integrator by its name; the engine keeps the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Method(pub(crate) Integrator);

impl JsonSchema for Method {
    fn schema_name() -> Cow<'static, str> {
        "Integrator".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "How the state is carried over a step.",
            "type": "string",
            "enum": Integrator::ALL.map(Integrator::name),
        })
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

impl<'de> Deserialize<'de> for Method {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map(Method).map_err(de::Error::custom)
    }
}

/// What acts on every particle.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Forces {
    /// The acceleration of gravity [m/s²]; none if left out.
    pub(crate) gravity: Option<Vector>,
    /// The coefficient of viscous drag on every particle [N·s/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) drag: f64,
}

/// What holds the constraints under the integrators that do not project; the others use none of it.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Feedback {
    /// How strongly C is pulled to zero [1/s²], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) ks: f64,
    /// How strongly the rate of C is pulled to zero [1/s], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) kd: f64,
    /// What is added to the diagonal of A, in the units of A, 0 or more; it softens every row.
    #[schemars(range(min = 0.0))]
    pub(crate) diagonal_drag: f64,
    /// The part of the constraint force that is left out, at least 0 (rigid) and below 1.
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub(crate) elasticity: f64,
}
