//! Area: a polygon keeps its area A(t), which may be driven, as if it were filled with an incompressible fluid. In the
//! plane only.
//!
//! ```text
//! C = ½ Σ (x_i − x_0) × (x_{i+1} − x_0) − A(t)       [m²],  λ: the pressure inside [N/m]
//! ∂C/∂x_i = ½ (y_{i+1} − y_{i−1}, x_{i−1} − x_{i+1})
//! C_t = −Ȧ
//! ```
//!
//! A is positive if the corners run counterclockwise. Positions count from x_0, so that a polygon far from the
//! origin keeps its digits. Sides may cross; the sum then counts each loop with its sign. Fails where all corners
//! are at one point, because the gradient vanishes there.

use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::driven::Driven;
use crate::number::{Number, minus};
use crate::point::Motion;
use crate::space::{ParticleId, first_repeated};

/// A polygon that keeps its area, in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// The corners in order, three or more, each particle once.
    pub corners: Vec<ParticleId>,
    /// A \[m²\], positive where the corners run counterclockwise.
    pub area: Driven,
}

impl Smooth for Area {
    const ONLY_IN: Option<usize> = Some(2);

    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.corners.get(i).copied()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let count = self.corners.len();
        let (area, rate) = self.area.at(at.t);
        let origin = at.x(0);
        let mut twice = N::constant(0.0);
        for i in 0..count {
            let (before, after) = (at.x((i + count - 1) % count), at.x((i + 1) % count));
            let (a, b) = (minus(at.x(i), origin), minus(after, origin));
            twice = twice + (a[0] * b[1] - a[1] * b[0]);
            let across = minus(after, before);
            gradient.push(std::array::from_fn(|k| if k == 0 { across[1].times(0.5) } else { across[0].times(-0.5) }));
        }
        Residual { C: twice.times(0.5) - area, C_t: -rate }
    }

    fn scale(&self, extent: f64) -> f64 {
        self.area.value(0.0).abs().max(extent * extent)
    }

    /// Each coordinate of a corner is in two entries of ½, one for each neighbour.
    fn curvature_bound<const D: usize>(&self, _: Motion<'_, D>) -> Option<f64> {
        Some(1.0)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.corners.len() < 3 {
            return Err(ConstraintError::PolygonCorners { count: self.corners.len() });
        }
        if let Some(corner) = first_repeated(self.corners.iter().copied()) {
            return Err(ConstraintError::PolygonCornerTwice { corner });
        }
        Ok(self.area.check("an area")?)
    }
}
