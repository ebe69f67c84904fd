//! CubicSpring: a damped spring with a cubic term. The spring stiffens with its extension for k₃ > 0, softens for k₃ <
//! 0, and has two stable lengths for k₁ < 0 < k₃.
//!
//! ```text
//! x = |L| − r                                                [m], L, L̇ and n as in `line.rs`
//! F_a = −[k₁ x + k₃ x³ + kd L̇·n] n,   F_b = −F_a            [N]
//! V   = ½ k₁ x² + ¼ k₃ x⁴                                    [J]
//! power of the damper = −kd (L̇·n)²                           [W]
//! −∂F_a/∂x_a = (k₁ + 3 k₃ x²) nnᵀ + [k₁ x + k₃ x³ + kd L̇·n] (I − nnᵀ)/|L| + kd nṅᵀ,   −∂F_a/∂v_a = kd nnᵀ
//! ```
//!
//! At |L| = 0 the direction is undefined, and the force is zero.

use super::line::Line;
use super::{Acts, Dependence, ForceError};
use crate::allowed::{finite, not_negative};
use crate::linalg::block::{Block, outer};
use crate::point::{Motion, add, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Spring between two particles with a cubic term.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicSpring {
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// k₁ [N/m], of either sign.
    pub stiffness: f64,
    /// k₃ [N/m³], of either sign.
    pub cubic: f64,
    /// kd [N·s/m], not negative.
    pub damping: f64,
    /// r \[m\], not negative.
    pub rest: f64,
}

impl CubicSpring {
    /// k₁ x + k₃ x³.
    fn pull(&self, length: f64) -> f64 {
        let x = length - self.rest;
        self.stiffness * x + self.cubic * x * x * x
    }

    /// k₁ + 3 k₃ x².
    fn along(&self, length: f64) -> f64 {
        let x = length - self.rest;
        self.stiffness + 3.0 * self.cubic * x * x
    }
}

impl Acts for CubicSpring {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        if let Some(Line { length, rate, n }) = Line::between(motion, self.a, self.b) {
            let pull = self.pull(length) + self.damping * rate;
            add(Q, self.a, scaled(-pull, n));
            add(Q, self.b, scaled(pull, n));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let x = norm(minus(motion.x(self.a), motion.x(self.b))) - self.rest;
        0.5 * self.stiffness * x * x + 0.25 * self.cubic * x * x * x * x
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        Line::between(motion, self.a, self.b).map_or(0.0, |line| -self.damping * line.rate * line.rate)
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let Some(Line { length, .. }) = Line::between(motion, self.a, self.b) else { return };
        // The row sum has a block for each end.
        let both_ends = 2.0 * self.along(length).abs().max(self.pull(length).abs() / length);
        bound(self.a, both_ends, 2.0 * self.damping);
        bound(self.b, both_ends, 2.0 * self.damping);
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        let Some(line) = Line::between(motion, self.a, self.b) else { return };
        // The damper also depends on q through n. This part is not symmetric and is left out; Newton's method converges
        // without it.
        let across = (self.pull(line.length) + self.damping * line.rate) / line.length;
        let along = outer(self.along(line.length) + rate * self.damping, line.n, line.n);
        visit(self.a, self.b, Stiffness::Difference(along));
        visit(self.a, self.b, Stiffness::Difference(line.across(across)));
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        let Some(line) = Line::between(motion, self.a, self.b) else { return };
        let pull = self.pull(line.length) + self.damping * line.rate;
        line.linearize(motion, (self.a, self.b), [pull, self.along(line.length), self.damping], visit);
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn check(&self) -> Result<(), ForceError> {
        finite("the stiffness of a cubic spring", self.stiffness)?;
        finite("the cubic stiffness of a spring", self.cubic)?;
        not_negative("the damping of a cubic spring", self.damping)?;
        not_negative("the rest length of a cubic spring", self.rest)?;
        if self.a == self.b { Err(ForceError::SameEnds { what: "a cubic spring" }) } else { Ok(()) }
    }
}
