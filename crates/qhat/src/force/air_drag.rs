//! AirDrag: drag of one particle in air that may move. The linear part is for slow small bodies, the quadratic part for
//! fast large bodies.
//!
//! ```text
//! w = w₀ + G x,   u = v − w                               [m/s]
//! F = −(c₁ + c₂ |u|) u                                    [N], c₁ in N·s/m, c₂ in N·s²/m²
//! power = F · v                                           [W], of either sign, because wind may push
//! B = −∂F/∂u = (c₁ + c₂ |u|) I + c₂ uuᵀ/|u|,   −∂F/∂v = B,   −∂F/∂x = −B G
//! ```
//!
//! w₀ is the wind at the origin and G [1/s] its gradient. A ball of radius R in a gas of density ϱ has c₂ = ½ c_w ϱ π
//! R² (c_w ≈ 0.47). At u = 0 there is no drag and |u| has no gradient; uuᵀ/|u| is taken as zero there.

use super::{Acts, Dependence, ForceError};
use crate::allowed::{all_finite, not_negative};
use crate::linalg::block::{Block, diagonal, outer, plus, product};
use crate::point::{Motion, Point, add, dot, first, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// Linear and quadratic drag of one particle in air that may move.
#[derive(Clone, Debug, PartialEq)]
pub struct AirDrag {
    /// The particle it acts on.
    pub particle: ParticleId,
    /// c₁ [N·s/m], not negative.
    pub linear: f64,
    /// c₂ [N·s²/m²], not negative.
    pub quadratic: f64,
    /// w₀ [m/s]; the third component is ignored in two dimensions.
    pub wind: [f64; 3],
    /// G [1/s]: row k is the gradient of the k-th component of the wind.
    pub gradient: [[f64; 3]; 3],
}

impl AirDrag {
    /// Drag in air at rest; c₁ in N·s/m, c₂ in N·s²/m².
    pub fn still(particle: ParticleId, linear: f64, quadratic: f64) -> Self {
        AirDrag { particle, linear, quadratic, wind: [0.0; 3], gradient: [[0.0; 3]; 3] }
    }

    /// u.
    fn relative<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        let (x, v) = (motion.x(self.particle), motion.v(self.particle));
        std::array::from_fn(|k| v[k] - (self.wind[k] + dot(first::<D>(&self.gradient[k]), x)))
    }

    /// rate B.
    fn resistance<const D: usize>(&self, motion: Motion<'_, D>, rate: f64) -> Block<D> {
        let u = self.relative(motion);
        let speed = norm(u);
        let B = diagonal(rate * (self.linear + self.quadratic * speed));
        if speed > 0.0 { plus(B, rate * self.quadratic / speed, outer(1.0, u, u)) } else { B }
    }

    fn force<const D: usize>(&self, motion: Motion<'_, D>) -> Point<D> {
        let u = self.relative(motion);
        scaled(-(self.linear + self.quadratic * norm(u)), u)
    }
}

impl Acts for AirDrag {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        add(Q, self.particle, self.force(motion));
    }

    fn potential<const D: usize>(&self, _: Motion<'_, D>, _: &[f64]) -> f64 {
        0.0
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        dot(self.force(motion), motion.v(self.particle))
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let most = self.linear + 2.0 * self.quadratic * norm(self.relative(motion));
        // |B| times the Frobenius norm of G bounds the rows of BG.
        let squares: f64 = self.gradient[..D].iter().map(|row| dot(first::<D>(row), first::<D>(row))).sum();
        bound(self.particle, most * squares.sqrt(), most);
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
        let B = self.resistance(motion, rate);
        // BG is not symmetric and is left out. For short steps it is small beside rate·B, so Newton's method converges
        // without it.
        visit(self.particle, self.particle, Stiffness::Difference(B));
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        let B = self.resistance(motion, 1.0);
        let G: Block<D> = std::array::from_fn(|k| first::<D>(&self.gradient[k]).map(|slope| -slope));
        visit(self.particle, self.particle, product(&B, &G), B);
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.particle]
    }

    fn check(&self) -> Result<(), ForceError> {
        not_negative("the linear drag coefficient", self.linear)?;
        not_negative("the quadratic drag coefficient", self.quadratic)?;
        all_finite("the wind", &self.wind)?;
        Ok(all_finite("the gradient of the wind", self.gradient.as_flattened())?)
    }
}
