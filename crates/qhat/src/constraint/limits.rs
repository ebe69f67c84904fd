//! Limits: the distance of two particles a and b is at least L₀ and at most L₁. A rope has only L₁, a loose strut only
//! L₀.
//!
//! ```text
//! d = x_a − x_b,   n = d/|d|,   u = v_a − v_b
//! longest   C = L₁ − |d| ≥ 0    J = −nᵀ on a, nᵀ on b     γ = −(u·u − (n·u)²)/|d|    λ ≥ 0 [N]: tension
//! shortest  C = |d| − L₀ ≥ 0    J = nᵀ on a, −nᵀ on b     γ = (u·u − (n·u)²)/|d|     λ ≥ 0 [N]: thrust
//! ∂²C/∂x² = ∓(I − nnᵀ)/|d| on aa and bb, its negative on ab
//! ```
//!
//! When a limit is reached, the relative velocity jumps: Ċ⁺ = −e Ċ⁻. Fails at |d| = 0, where d has no direction; n is
//! then the first axis.

use super::{ConstraintError, ContactRows, Formulation, Holds, RowWriter};
use crate::allowed::{check_impulse, check_restitution, check_strength, not_negative, positive};
use crate::linalg::block::{diagonal, outer, plus};
use crate::point::{Motion, Point, dot, first_axis, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Two particles whose distance stays between two limits: a rope, a strut.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// One end.
    pub a: ParticleId,
    /// The other end.
    pub b: ParticleId,
    /// L₀ \[m\], not negative.
    pub shortest: Option<f64>,
    /// L₁ \[m\], positive and more than L₀.
    pub longest: Option<f64>,
    /// e, in [0, 1]: the part of the closing speed that an impact at a limit gives back.
    pub restitution: f64,
    /// The tension or thrust at which the rope or strut breaks \[N\].
    pub breaks_at: Option<f64>,
    /// The impulse of a jerk or a blow at which it breaks \[N·s\].
    pub breaks_at_impulse: Option<f64>,
    /// EA \[N\], positive; 1 unless given. It only weighs how redundant rods and ropes share a force.
    pub stiffness: f64,
}

impl Limits {
    /// A rope: slack while shorter than its length \[m\], taut at its length.
    pub fn rope(a: ParticleId, b: ParticleId, length: f64) -> Self {
        Limits {
            a,
            b,
            shortest: None,
            longest: Some(length),
            restitution: 0.0,
            breaks_at: None,
            breaks_at_impulse: None,
            stiffness: 1.0,
        }
    }

    /// A loose strut: keeps two particles at least a length \[m\] apart.
    pub fn strut(a: ParticleId, b: ParticleId, length: f64) -> Self {
        Limits { longest: None, shortest: Some(length), ..Limits::rope(a, b, length) }
    }

    /// Both limits \[m\].
    pub fn between(a: ParticleId, b: ParticleId, shortest: f64, longest: f64) -> Self {
        Limits { shortest: Some(shortest), ..Limits::rope(a, b, longest) }
    }

    /// The same with the part of the closing speed that comes back where a limit is hit \[1\].
    pub fn with_restitution(self, restitution: f64) -> Self {
        Limits { restitution, ..self }
    }

    /// The same with the tension or thrust that it does not survive \[N\].
    pub fn breaking_at(self, tension: f64) -> Self {
        Limits { breaks_at: Some(tension), ..self }
    }

    /// The same with the impulse of a jerk or a blow \[N·s\] that it does not survive.
    pub fn breaking_at_impulse(self, impulse: f64) -> Self {
        Limits { breaks_at_impulse: Some(impulse), ..self }
    }

    /// The same with the stiffness EA \[N\] by which it shares a force with redundant rods and ropes.
    pub fn with_stiffness(self, stiffness: f64) -> Self {
        Limits { stiffness, ..self }
    }

    /// The limits with the sign of |d| in C: the longest first.
    fn rows(&self) -> impl Iterator<Item = (f64, f64)> {
        [(-1.0, self.longest), (1.0, self.shortest)].into_iter().filter_map(|(sign, limit)| Some((sign, limit?)))
    }

    /// Signed tension [N] from the multipliers of the rows, positive where the ends are pulled together.
    pub(crate) fn tension(&self, lambda: &[f64]) -> f64 {
        // The sum starts at +0, so that a slack rope has the tension 0 and not −0.
        self.rows().zip(lambda).fold(0.0, |pull, ((sign, _), lambda)| pull - sign * lambda)
    }
}

/// A rope, by its word in scenes: [`Limits`] with a longest length.
#[derive(Clone, Copy, Debug)]
pub enum Rope {}

impl Rope {
    /// A rope: slack up to its length \[m\], and then it does not stretch. The same as [`Limits::rope`].
    #[expect(clippy::new_ret_no_self, reason = "a rope is one form of limits")]
    pub fn new(a: ParticleId, b: ParticleId, length: f64) -> Limits {
        Limits::rope(a, b, length)
    }
}

/// A strut, by its word in scenes: [`Limits`] with a shortest length.
#[derive(Clone, Copy, Debug)]
pub enum Strut {}

impl Strut {
    /// A strut that keeps two particles at least so far apart \[m\]. The same as [`Limits::strut`].
    #[expect(clippy::new_ret_no_self, reason = "a strut is one form of limits")]
    pub fn new(a: ParticleId, b: ParticleId, length: f64) -> Limits {
        Limits::strut(a, b, length)
    }
}

impl Holds for Limits {
    fn row_count(&self, _: usize) -> usize {
        self.rows().count()
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b]
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let d = minus(motion.x(self.a), motion.x(self.b));
        let u = minus(motion.v(self.a), motion.v(self.b));
        let length = norm(d);
        let n = if length > 0.0 { scaled(1.0 / length, d) } else { first_axis() };
        let rate = dot(n, u);
        let gamma = if length > 0.0 { (dot(u, u) - rate * rate) / length } else { 0.0 };
        for (sign, limit) in self.rows() {
            let along: Point<D> = scaled(sign, n);
            rows.write(sign * (length - limit), sign * rate, sign * gamma, [along, scaled(-1.0, along)]);
        }
    }

    fn scale(&self, extent: f64) -> f64 {
        self.longest.or(self.shortest).filter(|&limit| limit > 0.0).unwrap_or(extent)
    }

    fn flexibility(&self, row: usize, _: f64) -> f64 {
        self.rows().nth(row).map_or(0.0, |(_, limit)| limit / self.stiffness)
    }

    fn contacts(&self, _: usize) -> [Option<ContactRows>; 2] {
        let count = self.rows().count();
        let restitution = self.restitution;
        let contact = |row: usize| ContactRows { normal: row, tangents: 0..0, restitution, friction: 0.0 };
        [0, 1].map(|row| (row < count).then(|| contact(row)))
    }

    fn breaks_at(&self) -> Option<f64> {
        self.breaks_at
    }

    fn breaks_at_impulse(&self) -> Option<f64> {
        self.breaks_at_impulse
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let length = norm(minus(motion.x(self.a), motion.x(self.b)));
        if length > 0.0 { 1.0 / length } else { 0.0 }
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        let d = minus(motion.x(self.a), motion.x(self.b));
        let length = norm(d);
        if length > 0.0 {
            let n = scaled(1.0 / length, d);
            let stiffness = self.tension(lambda) / length;
            visit(0, 1, Stiffness::Difference(plus(diagonal(stiffness), -stiffness, outer(1.0, n, n))));
        }
    }

    fn formulated(&self, _: Formulation) -> Self {
        self.clone()
    }

    fn check(&self) -> Result<(), ConstraintError> {
        if self.a == self.b {
            return Err(ConstraintError::SameEnds { what: "a rope or strut" });
        }
        match (self.shortest, self.longest) {
            (None, None) => return Err(ConstraintError::NoLimits),
            (Some(shortest), Some(longest)) if shortest >= longest => {
                return Err(ConstraintError::LimitsCrossed { shortest, longest });
            }
            _ => {}
        }
        not_negative("the shortest length", self.shortest.unwrap_or(0.0))?;
        if let Some(longest) = self.longest {
            positive("the longest length", longest)?;
        }
        positive("the stiffness of a rope or strut", self.stiffness)?;
        check_restitution(self.restitution)?;
        check_impulse(self.breaks_at_impulse)?;
        Ok(check_strength(self.breaks_at)?)
    }
}
