//! OnSphere: a particle at the distance r(t) from a point p(t) or from another particle: on a sphere in space, on a
//! circle in the plane, or at the end of a rod whose length is driven.
//!
//! ```text
//! d = x − p or x − x_p,   n = d/|d|,   C = |d| − r      1 row [m]
//! J = nᵀ on the particle, −nᵀ on the other particle,   C_t = −n·ṗ − ṙ
//! ```
//!
//! λ is the force of the sphere on the particle \[N\], outwards; the tension of a driven rod is −λ. Distance is the
//! same constraint with a fixed length. Only Distance has the squared form, compliance, and the fast code for large
//! systems. About a particle, both share a force with redundant rods alike.
//!
//! Fails at |d| = 0. There n is the first axis, so that a projection can still move the particle away from the centre.

use super::anchor::{Anchor, check_different};
use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::allowed::positive;
use crate::driven::Driven;
use crate::number::{Number, dot, minus, norm, scaled};
use crate::space::ParticleId;

/// A particle at a distance from a point or another particle.
#[derive(Clone, Debug, PartialEq)]
pub struct OnSphere {
    /// The particle.
    pub particle: ParticleId,
    /// The centre.
    pub center: Anchor,
    /// r \[m\], positive.
    pub radius: Driven,
    /// EA \[N\], positive; 1 unless given. It only weighs how redundant rods share a force, and only about a particle.
    pub stiffness: f64,
}

impl OnSphere {
    /// A particle at a distance \[m\] from a centre.
    pub fn new(particle: ParticleId, center: impl Into<Anchor>, radius: impl Into<Driven>) -> Self {
        OnSphere { particle, center: center.into(), radius: radius.into(), stiffness: 1.0 }
    }

    /// The same with the stiffness EA \[N\] by which a driven rod shares a force with redundant rods.
    pub fn with_stiffness(self, stiffness: f64) -> Self {
        OnSphere { stiffness, ..self }
    }
}

/// C = |d| − r with n.
pub(super) fn beyond<N: Number, const D: usize>(d: [N; D], r: N) -> (N, [N; D]) {
    let length = norm(d);
    if length.value() > 0.0 {
        return (length - r, scaled(N::constant(1.0) / length, d));
    }
    let first_axis = std::array::from_fn(|k| N::constant(if k == 0 { 1.0 } else { 0.0 }));
    (N::constant(0.0) - r, first_axis)
}

/// `Ok` if a radius is positive at the start.
pub(super) fn check_radius(radius: &Driven, what: &'static str) -> Result<(), ConstraintError> {
    radius.check(what)?;
    Ok(positive(what, radius.value(0.0))?)
}

impl Smooth for OnSphere {
    fn particle(&self, i: usize) -> Option<ParticleId> {
        [Some(self.particle), self.center.particle()].get(i).copied().flatten()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (p, pd) = self.center.at(|| at.x(1), at.t);
        let (r, rd) = self.radius.at(at.t);
        let (C, n) = beyond(minus(at.x(0), p), r);
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

    fn flexibility(&self, t: f64) -> f64 {
        // Without a second particle it is a guide and no rod.
        self.center.particle().map_or(0.0, |_| self.radius.value(t).abs() / self.stiffness)
    }

    fn check(&self) -> Result<(), ConstraintError> {
        positive("the stiffness of a rod", self.stiffness)?;
        self.center.check("the centre of a sphere")?;
        check_different([self.particle].into_iter().chain(self.center.particle()), "a sphere")?;
        check_radius(&self.radius, "the radius of a sphere")
    }
}
