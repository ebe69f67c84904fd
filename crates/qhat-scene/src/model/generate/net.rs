//! Net: particles in rows and columns, each linked to its neighbours in both.

use super::super::{Id, Vector, one};
use super::{Link, Plan, bow, point};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Particles in rows and columns, each linked to its neighbours: prefix0_0, prefix0_1, … with the row first.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Net {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The number of rows, 2 or more.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub(crate) rows: u32,
    /// The number of columns, 2 or more.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub(crate) columns: u32,
    /// The position of the first particle at the start [m].
    pub(crate) from: Vector,
    /// The offset from one column to the next [m].
    pub(crate) across: Vector,
    /// The offset from one row to the next [m].
    pub(crate) down: Vector,
    /// The offset of the middle of every row from the straight line [m], along a parabola; straight if left out.
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

impl Net {
    pub(crate) fn count(&self) -> u64 {
        u64::from(self.rows) * u64::from(self.columns)
    }

    pub(crate) fn plan(&self) -> Plan {
        let Net { prefix: Id(prefix), rows, columns, from, across, down, sag, .. } = self;
        let mut plan = Plan::default();
        for row in 0..*rows {
            for column in 0..*columns {
                let mut at = point(from, &[(f64::from(column), across), (f64::from(row), down)]);
                if let Some(sag) = sag {
                    at = point(&Vector(at), &[(bow(column, *columns), sag)]);
                }
                let here = plan.particle(format!("{prefix}{row}_{column}"), at);
                if column > 0 {
                    plan.links.push((here - 1, here));
                }
                if row > 0 {
                    plan.links.push((here - *columns as usize, here));
                }
            }
        }
        plan
    }
}
