//! The line between two particles, along which springs pull and actuators push.
//!
//! ```text
//! L = x_a − x_b,   L̇ = v_a − v_b,   n = L/|L|,   ∂(L̇·n)/∂L = ṅ
//! ```

use crate::linalg::block::{Block, diagonal, outer, plus};
use crate::point::{Motion, Point, dot, minus, norm, scaled};
use crate::space::ParticleId;

/// |L| [m], L̇·n [m/s] and n.
pub(super) struct Line<const D: usize> {
    pub(super) length: f64,
    pub(super) rate: f64,
    pub(super) n: Point<D>,
}

/// Calls `visit` with the four blocks of a force that depends on x_a − x_b and v_a − v_b alone.
pub(super) fn visit_both<const D: usize>(
    (a, b): (ParticleId, ParticleId),
    by_position: Block<D>,
    by_velocity: Block<D>,
    visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
) {
    let negative = |block: Block<D>| block.map(|row| row.map(|entry| -entry));
    visit(a, a, by_position, by_velocity);
    visit(b, b, by_position, by_velocity);
    visit(a, b, negative(by_position), negative(by_velocity));
    visit(b, a, negative(by_position), negative(by_velocity));
}

impl<const D: usize> Line<D> {
    /// The line from b to a; `None` at |L| = 0, where no direction is defined.
    pub(super) fn between(motion: Motion<'_, D>, a: ParticleId, b: ParticleId) -> Option<Self> {
        let L = minus(motion.x(a), motion.x(b));
        let Ld = minus(motion.v(a), motion.v(b));
        let length = norm(L);
        if length == 0.0 {
            return None;
        }
        let n = scaled(1.0 / length, L);
        Some(Line { length, rate: dot(Ld, n), n })
    }

    /// ṅ = (L̇ − (L̇·n) n)/|L|, of the line from b to a.
    fn turning(&self, motion: Motion<'_, D>, a: ParticleId, b: ParticleId) -> Point<D> {
        let Ld = minus(motion.v(a), motion.v(b));
        std::array::from_fn(|k| (Ld[k] - self.rate * self.n[k]) / self.length)
    }

    /// Calls `visit` with the blocks of a force −pull n on a and pull n on b, where pull = f(|L|) + kd L̇·n. `slope` is
    /// ∂f/∂|L|, `damping` is kd.
    pub(super) fn linearize(
        &self,
        motion: Motion<'_, D>,
        (a, b): (ParticleId, ParticleId),
        [pull, slope, damping]: [f64; 3],
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        let along = plus(self.across(pull / self.length), slope, outer(1.0, self.n, self.n));
        let turning = outer(damping, self.n, self.turning(motion, a, b));
        visit_both((a, b), plus(along, 1.0, turning), outer(damping, self.n, self.n), visit);
    }

    /// s (I − nnᵀ).
    pub(super) fn across(&self, s: f64) -> Block<D> {
        plus(diagonal(s), -s, outer(1.0, self.n, self.n))
    }
}
