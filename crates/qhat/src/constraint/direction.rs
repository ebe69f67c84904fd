//! Direction: the line from a to b has the direction u, which may be driven: a slider, a crank that turns with u(t).
//!
//! ```text
//! w = x_b − x_a,   C_k = (u × w)_k/|u|     1 row in the plane, 2 in space [m]
//! J = −∂C/∂w on a, ∂C/∂w on b,   C_t = ∂C/∂u · u̇      (moment.rs)
//! ```
//!
//! λ is a force across the line [N]. a may be on either side of b, and a and b may meet: nothing fails there. With a
//! fixed u every row is linear.

use super::anchor::{DrivenPoint, check_different, check_direction, check_point, follow, still};
use super::error::ConstraintError;
use super::moment::moment;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::number::{Number, dot, minus};
use crate::space::ParticleId;

/// Two particles whose connecting line has a given direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The particle where the line begins.
    pub a: ParticleId,
    /// The particle where the line ends.
    pub b: ParticleId,
    /// u, of any length; the third component is ignored in two dimensions.
    pub along: DrivenPoint,
}

impl Direction {
    /// The line from a to b along a fixed direction.
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

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (u, rate) = follow(&self.along, at.t);
        let (C, by_u, by_w) = moment(row, u, minus(at.x(1), at.x(0)));
        gradient.push(by_w.map(|g| -g));
        gradient.push(by_w);
        Residual { C, C_t: dot(by_u, rate) }
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
