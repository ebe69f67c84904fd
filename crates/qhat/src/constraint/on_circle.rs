//! OnCircle: a particle on a circle in space, of radius r(t), about a point p(t) or another particle, across an axis.
//!
//! ```text
//! d = x − p or x − x_p,   n = d/|d|
//! C_0 = â · d,     J = âᵀ,    C_t = −â·ṗ               (on_plane.rs)
//! C_1 = |d| − r,   J = nᵀ,    C_t = −n·ṗ − ṙ           (on_sphere.rs)
//! ```
//!
//! Two rows \[m\], whose gradients are at right angles on the circle. λ are the forces along the axis and outwards
//! \[N\]. Three dimensions only; in the plane, OnSphere is a circle. Fails in the centre, as OnSphere does, and on the
//! axis, where both gradients have the same direction.

use super::anchor::{Anchor, check_different, check_direction, check_point, still};
use super::error::ConstraintError;
use super::on_plane::height;
use super::on_sphere::{beyond, check_radius};
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::driven::Driven;
use crate::number::{Number, dot, minus};
use crate::space::ParticleId;

/// A particle on a circle in space.
#[derive(Clone, Debug, PartialEq)]
pub struct OnCircle {
    /// The particle.
    pub particle: ParticleId,
    /// The centre.
    pub center: Anchor,
    /// The axis, at right angles to the circle, of any length.
    pub axis: [f64; 3],
    /// r \[m\], positive.
    pub radius: Driven,
}

impl OnCircle {
    /// A particle on a circle of a radius \[m\] about a centre, at right angles to an axis.
    pub fn new(particle: ParticleId, center: impl Into<Anchor>, axis: [f64; 3], radius: impl Into<Driven>) -> Self {
        OnCircle { particle, center: center.into(), axis, radius: radius.into() }
    }
}

impl Smooth for OnCircle {
    fn row_count(&self, _: usize) -> usize {
        2
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        [Some(self.particle), self.center.particle()].get(i).copied().flatten()
    }

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (p, pd) = self.center.at(|| at.x(1), at.t);
        let d = minus(at.x(0), p);
        let (C, rd, n) = if row == 0 {
            let (C, _, axis) = height(std::array::from_fn(|k| N::constant(self.axis[k])), d);
            (C, N::constant(0.0), axis)
        } else {
            let (r, rd) = self.radius.at(at.t);
            let (C, n) = beyond(d, r);
            (C, rd, n)
        };
        gradient.push(n);
        if self.center.particle().is_some() {
            gradient.push(n.map(|g| -g));
        }
        Residual { C, C_t: -dot(n, pd) - rd }
    }

    fn may_jump(&self) -> bool {
        self.radius.is_driven()
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        self.center.particle().map(|center| [self.particle, center]).into_iter().collect()
    }

    fn least_size(&self, t: f64) -> f64 {
        self.radius.value(t)
    }

    fn scale(&self, _: f64) -> f64 {
        self.radius.value(0.0)
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        if dimension == 2 {
            return Err(ConstraintError::CircleInPlane);
        }
        check_direction(&still(self.axis), "the axis of a circle", dimension)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        self.center.check("the centre of a circle")?;
        check_point(&still(self.axis), "the axis of a circle")?;
        check_different([self.particle].into_iter().chain(self.center.particle()), "a circle")?;
        check_radius(&self.radius, "the radius of a circle")
    }
}
