//! InverseSquare: a softened inverse-square force between two particles: gravity between masses, electrostatics
//! between charges.
//!
//! ```text
//! d = x_a − x_b,   ρ = √(|d|² + ε²)                     [m]
//! V   = s/ρ                                              [J]
//! F_a = −∂V/∂x_a = s d/ρ³,   F_b = −F_a                  [N]
//! −∂F_a/∂x_a = −s/ρ³ I + 3 s ddᵀ/ρ⁵                      [N/m]
//! ```
//!
//! s [N·m²] is −G m_a m_b for masses and k q_a q_b for charges; a negative s attracts. ε [m] is the softening length
//! (Plummer's): the force is then finite, |F| ≤ 0.385 |s|/ε². For ε = 0 and two particles at the same point, d
//! has no direction: the force is taken as zero there, and V is not finite. The eigenvalues of the stiffness are
//! −s/ρ³ and s (3|d|²/ρ² − 1)/ρ³, neither above 2|s|/ρ³.

use super::{Acts, Dependence, ForceError};
use crate::allowed::{finite, not_negative};
use crate::linalg::block::{Block, diagonal, outer};
use crate::point::{Motion, Point, add, dot, minus, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Inverse-square force between two particles: gravity or electrostatics.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseSquare {
    /// One particle.
    pub a: ParticleId,
    /// The other particle.
    pub b: ParticleId,
    /// s [N·m²]: −G m_a m_b or k q_a q_b. A negative s attracts.
    pub strength: f64,
    /// ε, the softening length \[m\], not negative.
    pub softening: f64,
}

/// s and ε of one force, with the equations of this file.
#[derive(Clone, Copy)]
pub(super) struct Law {
    pub(super) s: f64,
    pub(super) epsilon: f64,
}

impl Law {
    fn rho<const D: usize>(self, d: Point<D>) -> f64 {
        (dot(d, d) + self.epsilon * self.epsilon).sqrt()
    }

    /// V [J].
    pub(super) fn potential<const D: usize>(self, d: Point<D>) -> f64 {
        self.s / self.rho(d)
    }

    /// F_a [N].
    pub(super) fn force<const D: usize>(self, d: Point<D>) -> Point<D> {
        let rho = self.rho(d);
        if rho == 0.0 { [0.0; D] } else { scaled(self.s / (rho * rho * rho), d) }
    }

    /// 2|s|/ρ³ [N/m].
    pub(super) fn bound<const D: usize>(self, d: Point<D>) -> f64 {
        let rho = self.rho(d);
        if rho == 0.0 { 0.0 } else { 2.0 * self.s.abs() / (rho * rho * rho) }
    }

    /// The two terms of −∂F_a/∂x_a, each of one sign [N/m].
    pub(super) fn stiffness<const D: usize>(self, d: Point<D>) -> Option<[Block<D>; 2]> {
        let rho = self.rho(d);
        if rho == 0.0 {
            return None;
        }
        let across = self.s / (rho * rho * rho);
        Some([diagonal(-across), outer(3.0 * across / (rho * rho), d, d)])
    }

    pub(super) fn check(self) -> Result<(), ForceError> {
        finite("the strength of an inverse-square force", self.s)?;
        Ok(not_negative("a softening length", self.epsilon)?)
    }
}

impl InverseSquare {
    /// Gravity between masses \[kg\]; the gravitational constant in m³/(kg·s²), the softening length in m.
    pub fn gravity(ids: [ParticleId; 2], masses: [f64; 2], constant: f64, softening: f64) -> Self {
        InverseSquare { a: ids[0], b: ids[1], strength: -constant * masses[0] * masses[1], softening }
    }

    /// Electrostatics between charges \[C\]; Coulomb's constant in N·m²/C², the softening length in m.
    pub fn charges(ids: [ParticleId; 2], charges: [f64; 2], constant: f64, softening: f64) -> Self {
        InverseSquare { a: ids[0], b: ids[1], strength: constant * charges[0] * charges[1], softening }
    }

    fn law(&self) -> Law {
        Law { s: self.strength, epsilon: self.softening }
    }

    fn apart<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        minus(motion.x(self.a), motion.x(self.b))
    }
}

impl Acts for InverseSquare {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let force = self.law().force(self.apart(motion));
        add(Q, self.a, force);
        add(Q, self.b, scaled(-1.0, force));
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        self.law().potential(self.apart(motion))
    }

    fn power<const D: usize>(&self, _: Motion<'_, D>) -> f64 {
        0.0
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        // The row sum has a block for each end.
        let both_ends = 2.0 * self.law().bound(self.apart(motion));
        bound(self.a, both_ends, 0.0);
        bound(self.b, both_ends, 0.0);
    }

    fn dependence(&self) -> Dependence {
        Dependence::Motion
    }

    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        _: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    ) {
        for term in self.law().stiffness(self.apart(motion)).into_iter().flatten() {
            visit(self.a, self.b, Stiffness::Difference(term));
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn check(&self) -> Result<(), ForceError> {
        self.law().check()?;
        if self.a == self.b { Err(ForceError::SameEnds { what: "an inverse-square force" }) } else { Ok(()) }
    }
}
