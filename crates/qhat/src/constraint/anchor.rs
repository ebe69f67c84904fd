//! Anchor: the point that a constraint measures from: a fixed point, a driven point or a particle.

use super::error::ConstraintError;
use crate::allowed::ValueError;
use crate::driven::Driven;
use crate::number::Number;
use crate::space::{ParticleId, first_repeated};

/// A point or vector whose components may be driven; the third is ignored in two dimensions.
pub type DrivenPoint = [Driven; 3];

/// The point that a constraint measures from: a point, fixed or driven, or a particle.
#[derive(Clone, Debug, PartialEq)]
pub enum Anchor {
    /// p(t) \[m\].
    Point(DrivenPoint),
    /// The position of a particle.
    Particle(ParticleId),
}

impl From<ParticleId> for Anchor {
    fn from(particle: ParticleId) -> Self {
        Anchor::Particle(particle)
    }
}

impl From<[f64; 3]> for Anchor {
    fn from(point: [f64; 3]) -> Self {
        Anchor::Point(still(point))
    }
}

impl Anchor {
    pub(super) fn particle(&self) -> Option<ParticleId> {
        if let Anchor::Particle(particle) = self { Some(*particle) } else { None }
    }

    /// p and ṗ. An anchor that is a particle is at `x` and has ṗ = 0, because the velocity of a particle is no part of
    /// C_t.
    pub(super) fn at<N: Number, const D: usize>(&self, x: impl FnOnce() -> [N; D], t: N) -> ([N; D], [N; D]) {
        match self {
            Anchor::Point(point) => follow(point, t),
            Anchor::Particle(_) => (x(), [N::constant(0.0); D]),
        }
    }

    pub(super) fn check(&self, what: &'static str) -> Result<(), ConstraintError> {
        if let Anchor::Point(point) = self { check_point(point, what) } else { Ok(()) }
    }
}

/// A fixed point.
pub(super) fn still(point: [f64; 3]) -> DrivenPoint {
    point.map(Driven::Constant)
}

/// p and ṗ of a driven point.
pub(super) fn follow<N: Number, const D: usize>(point: &DrivenPoint, t: N) -> ([N; D], [N; D]) {
    let components: [(N, N); D] = std::array::from_fn(|k| point[k].at(t));
    (components.map(|(value, _)| value), components.map(|(_, rate)| rate))
}

pub(super) fn check_point(point: &DrivenPoint, what: &'static str) -> Result<(), ConstraintError> {
    point.iter().try_for_each(|component| Ok(component.check(what)?))
}

/// `Ok` if a vector has a direction at t = 0 in d dimensions.
pub(super) fn check_direction(
    vector: &DrivenPoint,
    what: &'static str,
    dimension: usize,
) -> Result<(), ConstraintError> {
    let squares: f64 = vector[..dimension].iter().map(|component| component.value(0.0)).map(|x| x * x).sum();
    if squares.is_normal() { Ok(()) } else { Err(ValueError::NoDirection { what }.into()) }
}

/// `Ok` if all named particles are different.
pub(super) fn check_different(
    particles: impl Iterator<Item = ParticleId>,
    what: &'static str,
) -> Result<(), ConstraintError> {
    if first_repeated(particles).is_some() { Err(ConstraintError::NamedTwice { what }) } else { Ok(()) }
}
