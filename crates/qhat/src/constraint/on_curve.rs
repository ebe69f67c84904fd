//! OnCurve: a bead on a wire, a particle on a smooth curve c(s).
//!
//! With the foot s*(x) of the particle, w = x − c(s*) and ∂s*/∂x = c'/(c'·c' − w·c") (curve.rs):
//!
//! ```text
//! in the plane, 1 row [m], the distance with a sign:   n = (−c'_y, c'_x)/|c'|
//!   C = n·w,   J = nᵀ                          exact: w is along n, so ṅ and the motion of the foot drop out
//! in space, 2 rows [m]:   e_k the axes except the axis of the largest |c'_k|
//!   C_k = w_k,   J = e_kᵀ − c'_k (∂s*/∂x)ᵀ     w ⊥ c', so w is zero if two of its components are zero
//! ```
//!
//! λ is the force of the wire on the particle [N]. γ and the geometric stiffness follow from the change of J with x. In
//! space they leave out w·c‴, which is zero where the constraint holds. In the plane they are exact, for a spline, too.
//! The c‴ of a spline jumps at the given points, so a method of high order has a lower order there. At both ends of a
//! round corner of a polyline c" jumps (polyline.rs has the cost of such a jump).

use super::curve::{Curve, Foot};
use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::number::{Number, dot, norm};
use crate::space::ParticleId;

/// A particle on a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct OnCurve {
    /// The particle.
    pub particle: ParticleId,
    /// The curve.
    pub curve: Curve,
}

/// A particle on a curve whose foot is sought near a parameter.
#[derive(Clone, Copy)]
pub(crate) struct Followed<'a> {
    pub(super) bead: &'a OnCurve,
    /// Where the foot is expected; `None` where it is not known.
    pub(super) near: Option<f64>,
}

impl Smooth for OnCurve {
    fn row_count(&self, dimension: usize) -> usize {
        dimension - 1
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        (i == 0).then_some(self.particle)
    }

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        Followed { bead: self, near: None }.row(row, at, gradient)
    }

    fn scale(&self, extent: f64) -> f64 {
        extent
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        Ok(self.curve.fits(dimension)?)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        Ok(())
    }
}

impl Smooth for Followed<'_> {
    fn row_count(&self, dimension: usize) -> usize {
        Smooth::row_count(self.bead, dimension)
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.bead.particle(i)
    }

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let zero = N::constant(0.0);
        let Foot { w, tangent, slope } = self.bead.curve.foot(at.x(0), self.near);
        if D == 2 {
            let length = norm(tangent);
            let mut n = [zero; D];
            (n[0], n[1]) = (-tangent[1] / length, tangent[0] / length);
            gradient.push(n);
            return Residual { C: dot(n, w), C_t: zero };
        }
        let size = |k: usize| tangent[k].value().abs();
        let longest = (1..D).fold(0, |most, k| if size(k) > size(most) { k } else { most });
        let k = (longest + 1 + row) % D;
        gradient.push(std::array::from_fn(|j| N::constant(if j == k { 1.0 } else { 0.0 }) - tangent[k] * slope[j]));
        Residual { C: w[k], C_t: zero }
    }

    fn scale(&self, extent: f64) -> f64 {
        Smooth::scale(self.bead, extent)
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        Smooth::fits(self.bead, dimension)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        Smooth::check(self.bead)
    }
}
