//! Angle: the angle from one arm, or from a fixed direction, to another arm. It may follow α(t): a motor.
//!
//! ```text
//! u, w   the two arms, or u a fixed direction
//! n      plane: across it, so that angles count counterclockwise;   space: (u × w)/|u × w|
//! φ = atan2(n·(u × w), u·w)       from u to w: in (−π, π] in the plane, in [0, π] in space
//! ∂φ/∂w = n × w/|w|²,   ∂φ/∂u = −n × u/|u|²
//! C = φ − α(t)                    [rad],  less whole turns so that |C| ≤ π;   λ: a torque [N·m]
//! C_t = −α̇
//! ```
//!
//! The torque turns the second arm by +λ and the first arm by −λ, and the sum of all forces is zero. With a fixed
//! direction the ground takes the torque −λ. A motor gives the power λ α̇. In the plane α may run over any number of
//! turns: C does not count turns, so an arm in the direction α has C = 0 after any number of turns.
//!
//! Fails where an arm has no length. In the plane C jumps where φ differs from α by half a turn. In space φ has no
//! derivative at 0 and π: two arms in line are two conditions, not one. α must therefore stay between 0 and π. At a
//! failure the numbers are undefined, and the step ends in an error.

use super::arms::Arms;
use super::error::ConstraintError;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::allowed::all_finite;
use crate::driven::Driven;
use crate::number::{Number, cross, dot, norm, raised, scaled};
use crate::space::ParticleId;
use std::f64::consts::TAU;

/// The angle from one arm to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Angle {
    /// The first arm, unless the angle counts from a direction, and the second arm.
    arms: Arms,
    /// The direction u that the angle counts from; zero if it counts from an arm.
    direction: [f64; 3],
    pub(crate) angle: Driven,
}

impl Angle {
    /// The angle α \[rad\] from the arm `from` to the arm `to`, each from the first of its particles to the second.
    pub fn between(from: [ParticleId; 2], to: [ParticleId; 2], angle: impl Into<Driven>) -> Self {
        Angle { arms: Arms::new([from, to]), direction: [0.0; 3], angle: angle.into() }
    }

    /// The angle α \[rad\] from a direction of any length to the arm `to`. The third component of the direction is
    /// ignored in two dimensions.
    pub fn from_direction(direction: [f64; 3], to: [ParticleId; 2], angle: impl Into<Driven>) -> Self {
        Angle { arms: Arms::new([to]), direction, angle: angle.into() }
    }

    /// The first arm, `None` where the angle counts from a direction, and the second arm.
    pub fn arms(&self) -> (Option<[ParticleId; 2]>, [ParticleId; 2]) {
        if self.has_direction() { (None, self.arms.ends(0)) } else { (Some(self.arms.ends(0)), self.arms.ends(1)) }
    }

    /// The direction that the angle counts from; zero where it counts from an arm.
    pub fn direction(&self) -> [f64; 3] {
        self.direction
    }

    fn has_direction(&self) -> bool {
        self.arms.count() == 1
    }
}

impl Smooth for Angle {
    fn particle(&self, i: usize) -> Option<ParticleId> {
        self.arms.particles().get(i).copied()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (u, w): ([N; D], [N; D]) = match self.has_direction() {
            true => (std::array::from_fn(|k| N::constant(self.direction[k])), self.arms.vector(0, at)),
            false => (self.arms.vector(0, at), self.arms.vector(1, at)),
        };
        let across = cross(raised(u), raised(w));
        let [zero, one] = [0.0, 1.0].map(N::constant);
        let (sine, n) = if D == 2 {
            (across[2], [zero, zero, one])
        } else {
            let sine = norm(across);
            (sine, across.map(|component| component / sine))
        };
        let (angle, rate) = self.angle.at(at.t);
        let C = within_half_a_turn(N::atan2(sine, dot(u, w)) - angle);
        let turned = |arm: [N; D], sign: f64| -> [N; D] {
            let turned = cross(n, raised(arm));
            scaled(N::constant(sign) / dot(arm, arm), std::array::from_fn(|k| turned[k]))
        };
        let is_last = |arm: usize| arm + 1 == self.arms.count();
        self.arms.spread(|arm| if is_last(arm) { turned(w, 1.0) } else { turned(u, -1.0) }, gradient);
        Residual { C, C_t: -rate }
    }

    fn may_jump(&self) -> bool {
        true
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        self.arms.all()
    }

    fn scale(&self, _: f64) -> f64 {
        1.0
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if let Some(arm) = (0..self.arms.count()).find(|&arm| self.arms.is_without_length(arm)) {
            return Err(ConstraintError::ArmEnds { arm });
        }
        if self.has_direction() {
            all_finite("the direction", &self.direction)?;
            if self.direction == [0.0; 3] {
                return Err(ConstraintError::NoDirection);
            }
        }
        Ok(self.angle.check("an angle")?)
    }
}

/// The angle less whole turns, so that it is at most half a turn.
pub(super) fn within_half_a_turn<N: Number>(angle: N) -> N {
    angle - N::constant(TAU * (angle.value() / TAU).round())
}
