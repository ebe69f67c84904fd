//! OnPlane: a particle on a plane, through a point p across a normal n (both may be driven) or through three
//! particles a, b, c.
//!
//! ```text
//! w = x − p or x − x_a,   C = n̂ · w,   n̂ = n/|n|      1 row [m]
//! ∂C/∂w = n̂,   ∂C/∂n = (w − C n̂)/|n|                   C_t = ∂C/∂n · ṅ − n̂ · ṗ
//! three particles:  e = x_b − x_a,   f = x_c − x_a,   n = e × f
//! g = ∂C/∂n:     ∂C/∂e = f × g,   ∂C/∂f = g × e        −(their sum with n̂) on a
//! ```
//!
//! λ is the force of the plane on the particle [N]. Three dimensions only; in the plane, use OnLine. Fails where a, b
//! and c are in line, because they do not define a plane there; C is then NaN.

use super::anchor::{DrivenPoint, check_different, check_direction, check_point, follow, still};
use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::number::{Number, cross, dot, minus, norm, plus, scaled};
use crate::space::ParticleId;

/// The plane that a particle is on.
#[derive(Clone, Debug, PartialEq)]
pub enum Plane {
    /// Through p(t) \[m\] at right angles to n(t), of any length.
    Across(DrivenPoint, DrivenPoint),
    /// Through three particles.
    Particles([ParticleId; 3]),
}

/// A particle on a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct OnPlane {
    /// The particle.
    pub particle: ParticleId,
    /// The plane.
    pub plane: Plane,
}

impl OnPlane {
    /// A particle on a fixed plane, through a point \[m\] at right angles to a normal.
    pub fn fixed(particle: ParticleId, point: [f64; 3], normal: [f64; 3]) -> Self {
        OnPlane { particle, plane: Plane::Across(still(point), still(normal)) }
    }

    /// A particle on the plane through three particles.
    pub fn through(particle: ParticleId, corners: [ParticleId; 3]) -> Self {
        OnPlane { particle, plane: Plane::Particles(corners) }
    }
}

/// C = n̂ · w with ∂C/∂n and n̂.
pub(super) fn height<N: Number, const D: usize>(n: [N; D], w: [N; D]) -> (N, [N; D], [N; D]) {
    let inverse = N::constant(1.0) / norm(n);
    let unit = scaled(inverse, n);
    let C = dot(unit, w);
    (C, scaled(inverse, minus(w, scaled(C, unit))), unit)
}

impl Smooth for OnPlane {
    fn particle(&self, i: usize) -> Option<ParticleId> {
        match (i, &self.plane) {
            (0, _) => Some(self.particle),
            (_, Plane::Particles(corners)) => corners.get(i - 1).copied(),
            _ => None,
        }
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        match &self.plane {
            Plane::Across(point, normal) => {
                let ((p, pd), (n, nd)) = (follow(point, at.t), follow(normal, at.t));
                let (C, by_n, unit) = height(n, minus(at.x(0), p));
                gradient.push(unit);
                Residual { C, C_t: dot(by_n, nd) - dot(unit, pd) }
            }
            Plane::Particles(_) => {
                let (e, f) = (minus(at.x(2), at.x(1)), minus(at.x(3), at.x(1)));
                let (C, by_n, unit) = height(cross(e, f), minus(at.x(0), at.x(1)));
                let (by_e, by_f) = (cross(f, by_n), cross(by_n, e));
                gradient.push(unit);
                gradient.push(plus(unit, plus(by_e, by_f)).map(|g| -g));
                gradient.push(by_e);
                gradient.push(by_f);
                Residual { C, C_t: N::constant(0.0) }
            }
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        extent
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        if dimension == 2 {
            return Err(ConstraintError::PlaneInPlane);
        }
        match &self.plane {
            Plane::Across(_, normal) => check_direction(normal, "the normal of a plane", dimension),
            Plane::Particles(_) => Ok(()),
        }
    }

    fn check(&self) -> Result<(), ConstraintError> {
        match &self.plane {
            Plane::Across(point, normal) => {
                check_point(point, "the point of a plane")?;
                check_point(normal, "the normal of a plane")
            }
            Plane::Particles(corners) => check_different(corners.iter().copied().chain([self.particle]), "a plane"),
        }
    }
}
