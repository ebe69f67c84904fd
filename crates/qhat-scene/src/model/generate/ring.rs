//! Ring: particles on a circle, each linked to the next and the last to the first.

use super::super::{Id, Vector, one};
use super::{Link, Plan};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Particles on a circle in the x–y plane, each linked to the next, the last to the first: prefix0 at the angle 0, …
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ring {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The number of particles, 3 or more.
    #[schemars(range(min = 3, max = 1_000_000))]
    pub(crate) count: u32,
    /// The centre of the circle [m].
    pub(crate) center: Vector,
    /// The radius of the circle [m], above 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) radius: f64,
    /// The mass of each particle [kg], above 0.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub(crate) mass: f64,
    /// The velocity of each particle at the start [m/s]; at rest if left out.
    #[serde(default)]
    pub(crate) velocity: Option<Vector>,
    /// Whether all its particles stay at their positions.
    #[serde(default)]
    pub(crate) fixed: bool,
    /// The links between neighbours; rods if left out.
    #[serde(default)]
    pub(crate) link: Link,
}

impl Ring {
    pub(crate) fn count(&self) -> u64 {
        u64::from(self.count)
    }

    pub(crate) fn plan(&self) -> Plan {
        let Ring { prefix: Id(prefix), count: n, center, radius, .. } = self;
        let mut plan = Plan::default();
        for i in 0..*n {
            let angle = TAU * f64::from(i) / f64::from(*n);
            let mut at = center.0.clone();
            // libm, not std: the same bits in the browser.
            at[0] += radius * libm::cos(angle);
            at[1] += radius * libm::sin(angle);
            let here = plan.particle(format!("{prefix}{i}"), at);
            if here > 0 {
                plan.links.push((here - 1, here));
            }
        }
        plan.links.push((plan.particles.len() - 1, 0));
        plan
    }
}
