//! Chain: particles in a row, each linked to the next.

use super::super::{Id, Vector, one};
use super::{Link, Plan, bow, point};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Particles in a row, each linked to the next: prefix0, prefix1, …
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Chain {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The number of particles, 2 or more.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub(crate) count: u32,
    /// The position of the first particle at the start [m].
    pub(crate) from: Vector,
    /// The position of the last particle at the start [m].
    pub(crate) to: Vector,
    /// The offset of the middle from the straight line [m], along a parabola; straight if left out.
    #[serde(default)]
    pub(crate) sag: Option<Vector>,
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

impl Chain {
    pub(crate) fn count(&self) -> u64 {
        u64::from(self.count)
    }

    pub(crate) fn plan(&self) -> Plan {
        let Chain { prefix: Id(prefix), count: n, from, to, sag, .. } = self;
        let mut plan = Plan::default();
        for i in 0..*n {
            let s = f64::from(i) / f64::from(n - 1);
            let mut at = point(&Vector(vec![0.0; from.0.len()]), &[(1.0 - s, from), (s, to)]);
            if let Some(sag) = sag {
                at = point(&Vector(at), &[(bow(i, *n), sag)]);
            }
            let here = plan.particle(format!("{prefix}{i}"), at);
            if here > 0 {
                plan.links.push((here - 1, here));
            }
        }
        plan
    }
}
