//! `[step]`, `[forces]` and `[feedback]`. The defaults are the engine's own.

use super::Vector;
use super::integrator::Method;
use qhat::Settings;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The settings of a run.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Step {
    /// The step of a fixed-step integrator, the frame of an adaptive one [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) h: f64,
    /// The integrator.
    pub(crate) integrator: Method,
    /// The relative error of a substep that adaptive integrators aim at, between 0 and 1.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub(crate) tolerance: f64,
    /// The largest |C| that a projection leaves, relative to the length scale of its row, from 1e-14 to 1e-2.
    #[schemars(range(min = 1e-14, max = 1e-2))]
    pub(crate) constraint_tolerance: f64,
    /// The most substeps that an adaptive integrator may take in a frame, 1 or more; a frame that needs more is an
    /// error, or under auto goes to bdf2.
    #[schemars(range(min = 1))]
    pub(crate) max_substeps: u32,
    /// The most Newton iterations that implicit and bdf2 may take in a frame, 1 or more; a frame that
    /// needs more gives a warning with its remaining error.
    #[schemars(range(min = 1))]
    pub(crate) frame_budget: u32,
    /// The most row solves that auto may take in a frame before bdf2 replaces dop853 and radau5, 1 or more.
    #[schemars(range(min = 1))]
    pub(crate) frame_work: u32,
    /// The duration of a run of the scene [s], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) duration: f64,
}

impl Default for Step {
    fn default() -> Self {
        let settings = Settings::default();
        let count = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        Step {
            h: settings.h,
            integrator: Method(settings.integrator),
            tolerance: settings.tolerance,
            constraint_tolerance: settings.constraint_tolerance,
            max_substeps: count(settings.max_substeps),
            frame_budget: count(settings.frame_budget),
            frame_work: count(settings.frame_work),
            duration: 10.0,
        }
    }
}

/// The forces on every particle.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Forces {
    /// The acceleration of gravity [m/s²]; none if left out.
    pub(crate) gravity: Option<Vector>,
    /// The coefficient of viscous drag on every particle [N·s/m], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) drag: f64,
}

/// The feedback that keeps constraints near zero under integrators that do not project; the others use none of it.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Feedback {
    /// The gain of the residual C [1/s²], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) ks: f64,
    /// The gain of the rate of C [1/s], 0 or more.
    #[schemars(range(min = 0.0))]
    pub(crate) kd: f64,
    /// The number added to the diagonal of A, in the units of A, 0 or more; it softens every row.
    #[schemars(range(min = 0.0))]
    pub(crate) diagonal_drag: f64,
    /// The part of the constraint force that is left out, at least 0 (rigid) and below 1.
    #[schemars(range(min = 0.0), extend("exclusiveMaximum" = 1.0))]
    pub(crate) elasticity: f64,
}
