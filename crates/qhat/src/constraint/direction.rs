//! Direction: the line from a to b keeps the direction u, or follows it: a slider, a crank that turns as u(t) does.
//!
//! ```text
//! w = x_b − x_a,   C_k = (u × w)_k/|u|     1 row in the plane, 2 in space [m]
//! J = −∂C/∂w on a, ∂C/∂w on b,   C_t = ∂C/∂u · u̇      (moment.rs)
//! ```
//!
//! λ is a force across the line [N]. a may be on either side of b, and they may meet: nothing fails there. With u at rest every row is linear.

use super::anchor::{DrivenPoint, check_different, check_direction, check_point, follow, still};
use super::error::ConstraintError;
use super::moment::moment;
use super::smooth::Smooth;
use crate::number::{Number, dot, minus};
use crate::space::ParticleId;

/// Two particles whose connecting line has a given direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// Where the line begins.
    pub a: ParticleId,
    /// Where it ends.
    pub b: ParticleId,
    /// u, of any length; the third component is ignored in two dimensions.
    pub along: DrivenPoint,
}

impl Direction {
    /// The line from a to b along a direction that stays.
    pub fn new(a: ParticleId, b: ParticleId, along: [f64; 3]) -> Self {
        Direction { a, b, along: still(along) }
    }
}

impl Smooth for Direction {
    fn row_count(&self, dimension: usize) -> usize {
        dimension - 1
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        [self.a, self.b].get(i).copied()
    }

    fn row<N: Number, const D: usize>(
        &self,
        row: usize,
        x: &impl Fn(usize) -> [N; D],
        t: N,
        gradient: &mut impl FnMut([N; D]),
    ) -> (N, N) {
        let (u, rate) = follow(&self.along, t);
        let (C, by_u, by_w) = moment(row, u, minus(x(1), x(0)));
        gradient(by_w.map(|g| -g));
        gradient(by_w);
        (C, dot(by_u, rate))
    }

    fn scale(&self, extent: f64) -> f64 {
        extent
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        check_direction(&self.along, "the direction of a line", dimension)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        check_different([self.a, self.b].into_iter(), "a direction")?;
        check_point(&self.along, "the direction of a line")
    }
}
