//! OnLine: a particle on a line, through a point p along u (both may be driven) or through two particles a and b.
//!
//! ```text
//! d = u or x_b − x_a,   w = x − p or x − x_a
//! C_k = (d × w)_k/|d|                                       1 row in the plane, 2 in space [m]   (moment.rs)
//! J = ∂C/∂w on the particle;  ∂C/∂d on b, −∂C/∂w − ∂C/∂d on a
//! C_t = ∂C/∂d · u̇ − ∂C/∂w · ṗ
//! ```
//!
//! λ is the force of the line on the particle [N]. The line has no ends: it extends beyond a and b. Fails where a and b
//! meet, because they do not define a line there; C is then NaN.

use super::anchor::{DrivenPoint, check_different, check_direction, check_point, follow, still};
use super::error::ConstraintError;
use super::moment::moment;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::number::{Number, dot, minus, plus};
use crate::space::ParticleId;

/// The line that a particle is on.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// Through p(t) \[m\] along u(t), of any length.
    Through(DrivenPoint, DrivenPoint),
    /// Through two particles.
    Particles(ParticleId, ParticleId),
}

/// A particle on a line.
#[derive(Clone, Debug, PartialEq)]
pub struct OnLine {
    /// The particle.
    pub particle: ParticleId,
    /// The line.
    pub line: Line,
}

impl OnLine {
    /// A particle on a fixed line, through a point \[m\] along a direction.
    pub fn fixed(particle: ParticleId, point: [f64; 3], along: [f64; 3]) -> Self {
        OnLine { particle, line: Line::Through(still(point), still(along)) }
    }

    /// A particle on the line through a and b.
    pub fn through(particle: ParticleId, a: ParticleId, b: ParticleId) -> Self {
        OnLine { particle, line: Line::Particles(a, b) }
    }
}

impl Smooth for OnLine {
    fn row_count(&self, dimension: usize) -> usize {
        dimension - 1
    }

    fn particle(&self, i: usize) -> Option<ParticleId> {
        match (i, &self.line) {
            (0, _) => Some(self.particle),
            (1, Line::Particles(a, _)) => Some(*a),
            (2, Line::Particles(_, b)) => Some(*b),
            _ => None,
        }
    }

    fn row<N: Number, const D: usize>(&self, row: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        match &self.line {
            Line::Through(point, along) => {
                let ((p, pd), (u, ud)) = (follow(point, at.t), follow(along, at.t));
                let (C, by_u, by_w) = moment(row, u, minus(at.x(0), p));
                gradient.push(by_w);
                Residual { C, C_t: dot(by_u, ud) - dot(by_w, pd) }
            }
            Line::Particles(..) => {
                let (C, by_d, by_w) = moment(row, minus(at.x(2), at.x(1)), minus(at.x(0), at.x(1)));
                gradient.push(by_w);
                gradient.push(plus(by_w, by_d).map(|g| -g));
                gradient.push(by_d);
                Residual { C, C_t: N::constant(0.0) }
            }
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        extent
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        match &self.line {
            Line::Through(_, along) => check_direction(along, "the direction of a line", dimension),
            Line::Particles(..) => Ok(()),
        }
    }

    fn check(&self) -> Result<(), ConstraintError> {
        match &self.line {
            Line::Through(point, along) => {
                check_point(point, "the point of a line")?;
                check_point(along, "the direction of a line")
            }
            Line::Particles(a, b) => check_different([self.particle, *a, *b].into_iter(), "a line"),
        }
    }
}
