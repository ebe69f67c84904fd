//! Truss: a girder of triangles.

use super::super::{Id, Vector, one};
use super::{Link, Plan, point};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A girder: prefix_low0, prefix_low1, … along the bottom, prefix_top0, … along the top.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Truss {
    /// The beginning of the ids of its particles.
    pub(crate) prefix: Id,
    /// The pattern of its triangles.
    #[serde(default)]
    pub(crate) pattern: Pattern,
    /// The number of bays, 1 or more.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub(crate) bays: u32,
    /// The position at which the bottom begins [m].
    pub(crate) from: Vector,
    /// The position at which the bottom ends [m].
    pub(crate) to: Vector,
    /// The offset from the bottom to the top [m].
    pub(crate) rise: Vector,
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

/// The pattern of the triangles of a truss.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Pattern {
    /// A top particle above the middle of every bay: isosceles triangles, no redundant rod.
    #[default]
    Warren,
    /// A top particle above every bottom particle, and one diagonal a bay, falling towards the middle.
    Pratt,
    /// A top particle above every bottom particle, and both diagonals a bay: one redundant rod in each bay.
    Crossed,
}

impl Truss {
    pub(crate) fn count(&self) -> u64 {
        let bays = u64::from(self.bays);
        match self.pattern {
            Pattern::Warren => 2 * bays + 1,
            Pattern::Pratt | Pattern::Crossed => 2 * (bays + 1),
        }
    }

    pub(crate) fn plan(&self) -> Plan {
        let mut plan = Plan::default();
        let bays = self.bays as usize;
        let low: Vec<usize> = (0..=bays).map(|i| self.joint(&mut plan, "low", i, i as f64, 0.0)).collect();
        for i in 0..bays {
            plan.links.push((low[i], low[i + 1]));
        }
        let (tops, offset) = if self.pattern == Pattern::Warren { (bays, 0.5) } else { (bays + 1, 0.0) };
        let top: Vec<usize> = (0..tops).map(|i| self.joint(&mut plan, "top", i, i as f64 + offset, 1.0)).collect();
        for i in 1..tops {
            plan.links.push((top[i - 1], top[i]));
        }
        for i in 0..tops {
            plan.links.push((low[i], top[i]));
        }
        for i in 0..bays {
            let falling = (top[i], low[i + 1]);
            match self.pattern {
                Pattern::Warren => plan.links.push(falling),
                Pattern::Pratt if 2 * i < bays => plan.links.push(falling),
                Pattern::Pratt => plan.links.push((low[i], top[i + 1])),
                Pattern::Crossed => plan.links.extend([falling, (low[i], top[i + 1])]),
            }
        }
        plan
    }

    /// Adds the joint that is `place` bays from the start, at the bottom (height 0) or the top (height 1).
    fn joint(&self, plan: &mut Plan, chord: &str, index: usize, place: f64, height: f64) -> usize {
        let s = place / f64::from(self.bays);
        let along = point(&Vector(vec![0.0; self.from.0.len()]), &[(1.0 - s, &self.from), (s, &self.to)]);
        plan.particle(format!("{}_{chord}{index}", self.prefix.0), point(&Vector(along), &[(height, &self.rise)]))
    }
}
