//! Spring: a damped Hookean spring. It is the external force of the source with the sign of the damping corrected.
//!
//! ```text
//! L = x_a − x_b,   L̇ = v_a − v_b,   n = L/|L|
//! F_a = −[ks (|L| − r) + kd L̇·n] n,   F_b = −F_a           [N]
//! V   = ½ ks (|L| − r)²                                     [J]
//! power of the damper = −kd (L̇·n)²                          [W]
//! −∂F_a/∂x_a = ks nnᵀ + [ks (|L| − r) + kd L̇·n] (I − nnᵀ)/|L| + kd nṅᵀ,   −∂F_a/∂v_a = kd nnᵀ
//! ```
//!
//! ks [N/m] and kd [N·s/m] are the spring's own and not the feedback coefficients of the same name. At |L| = 0 the
//! direction is undefined, and the force is zero, which is exact for r = 0.

use super::line::{Line, visit_both};
use super::{Acts, Dependence, ForceError};
use crate::allowed::not_negative;
use crate::linalg::block::{Block, diagonal, outer, zero};
use crate::point::{Motion, add, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Damped Hookean spring between two particles.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// ks [N/m], not negative.
    pub stiffness: f64,
    /// kd [N·s/m], not negative.
    pub damping: f64,
    /// r, the rest length \[m\], not negative.
    pub rest: f64,
}

impl Acts for Spring {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        if let Some(Line { length, rate, n }) = Line::between(motion, self.a, self.b) {
            let pull = self.stiffness * (length - self.rest) + self.damping * rate;
            add(Q, self.a, scaled(-pull, n));
            add(Q, self.b, scaled(pull, n));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let length = norm(minus(motion.x(self.a), motion.x(self.b)));
        0.5 * self.stiffness * (length - self.rest) * (length - self.rest)
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        Line::between(motion, self.a, self.b).map_or(0.0, |line| -self.damping * line.rate * line.rate)
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let Some(Line { length, .. }) = Line::between(motion, self.a, self.b) else { return };
        // The stiffness is ks along the spring and pull/|L| across it; the row sum has a block for each end.
        let across = self.stiffness * (length - self.rest).abs() / length;
        let both_ends = 2.0 * self.stiffness.max(across);
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
        let Some(line) = Line::between(motion, self.a, self.b) else {
            // A spring of rest length zero is linear and has the stiffness ks in every direction.
            if self.rest == 0.0 {
                visit(self.a, self.b, Stiffness::Difference(diagonal(self.stiffness)));
            }
            return;
        };
        // The damper also depends on q through n. This part is not symmetric and is left out; Newton's method converges
        // without it.
        let across = (self.stiffness * (line.length - self.rest) + self.damping * line.rate) / line.length;
        let definite = outer(self.stiffness + rate * self.damping, line.n, line.n);
        let geometric = line.across(across);
        visit(self.a, self.b, Stiffness::Difference(definite));
        visit(self.a, self.b, Stiffness::Difference(geometric));
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        let Some(line) = Line::between(motion, self.a, self.b) else {
            if self.rest == 0.0 {
                visit_both((self.a, self.b), diagonal(self.stiffness), zero(), visit);
            }
            return;
        };
        let pull = self.stiffness * (line.length - self.rest) + self.damping * line.rate;
        line.linearize(motion, (self.a, self.b), [pull, self.stiffness, self.damping], visit);
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn check(&self) -> Result<(), ForceError> {
        not_negative("the stiffness of a spring", self.stiffness)?;
        not_negative("the damping of a spring", self.damping)?;
        not_negative("the rest length of a spring", self.rest)?;
        if self.a == self.b { Err(ForceError::SameEnds { what: "a spring" }) } else { Ok(()) }
    }
}
