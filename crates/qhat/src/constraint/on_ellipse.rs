//! OnEllipse: a particle on an ellipse about a point p(t) or another particle, with half axes a(t) along u and b(t)
//! across it. In the plane.
//!
//! ```text
//! d = x − p or x − x_p,   û = u/|u|,   û⊥ = û turned by a quarter turn to the left
//! e = (û·d/a, û⊥·d/b),   ρ = |e|,   c = √(a b),   C = c (ρ − 1)                       1 row [m]
//! J = gᵀ on the particle, −gᵀ on the other,   g = ∂C/∂d = c/ρ (e_1/a û + e_2/b û⊥)
//! C_t = −g·ṗ − c/ρ (e_1² ȧ/a + e_2² ḃ/b) + ċ (ρ − 1),   ċ = (ȧ b + a ḃ)/(2 c)
//! ```
//!
//! λ |g| is the force of the ellipse on the particle [N], outwards where λ > 0; |g| = 1 on a circle. Fails in the
//! centre, where ρ has no gradient: the first axis is taken for it, so that a projection can still pull the particle
//! out.

use super::anchor::{Anchor, check_different, check_direction, check_point, still};
use super::error::ConstraintError;
use super::on_sphere::check_radius;
use super::smooth::{At, Gradient, Residual, Smooth};
use crate::driven::Driven;
use crate::number::{Number, dot, minus, plus, scaled};
use crate::space::ParticleId;

/// A particle on an ellipse, in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct OnEllipse {
    /// The particle.
    pub particle: ParticleId,
    /// The centre.
    pub center: Anchor,
    /// u, the direction of the first axis, of any length; the third component is ignored.
    pub along: [f64; 3],
    /// a along u and b across it \[m\], positive.
    pub half: [Driven; 2],
}

impl OnEllipse {
    /// On an ellipse about a centre, with its first axis in a direction and half axes \[m\] along and across it.
    pub fn new(particle: ParticleId, center: impl Into<Anchor>, along: [f64; 3], half: [impl Into<Driven>; 2]) -> Self {
        OnEllipse { particle, center: center.into(), along, half: half.map(Into::into) }
    }
}

impl Smooth for OnEllipse {
    const ONLY_IN: Option<usize> = Some(2);

    fn particle(&self, i: usize) -> Option<ParticleId> {
        [Some(self.particle), self.center.particle()].get(i).copied().flatten()
    }

    fn row<N: Number, const D: usize>(&self, _: usize, at: &At<N, D>, gradient: &mut Gradient<N, D>) -> Residual<N> {
        let (p, pd) = self.center.at(|| at.x(1), at.t);
        let [(a, ad), (b, bd)] = [self.half[0].at(at.t), self.half[1].at(at.t)];
        let d = minus(at.x(0), p);
        let [ux, uy, _] = self.along;
        let size = (ux * ux + uy * uy).sqrt();
        let axis = |x: f64, y: f64| -> [N; D] {
            std::array::from_fn(|k| N::constant([x, y].get(k).map_or(0.0, |component| component / size)))
        };
        let (u, across) = (axis(ux, uy), axis(-uy, ux));
        let (e1, e2) = (dot(u, d) / a, dot(across, d) / b);
        let (rho, c) = ((e1 * e1 + e2 * e2).sqrt(), (a * b).sqrt());
        let one = N::constant(1.0);
        let (n1, n2) = if rho.value() > 0.0 { (e1 / rho, e2 / rho) } else { (one, N::constant(0.0)) };
        let g = scaled(c, plus(scaled(n1 / a, u), scaled(n2 / b, across)));
        gradient.push(g);
        if self.center.particle().is_some() {
            gradient.push(g.map(|g| -g));
        }
        let cd = (ad * b + a * bd).times(0.5) / c;
        let stretching = c * (n1 * e1 * ad / a + n2 * e2 * bd / b);
        Residual { C: c * (rho - one), C_t: cd * (rho - one) - dot(g, pd) - stretching }
    }

    fn may_jump(&self) -> bool {
        self.half.iter().any(Driven::is_driven)
    }

    fn arms(&self) -> Vec<[ParticleId; 2]> {
        self.center.particle().map(|center| [self.particle, center]).into_iter().collect()
    }

    fn least_size(&self, t: f64) -> f64 {
        self.half[0].value(t).min(self.half[1].value(t))
    }

    fn scale(&self, _: f64) -> f64 {
        (self.half[0].value(0.0) * self.half[1].value(0.0)).sqrt()
    }

    fn check(&self) -> Result<(), ConstraintError> {
        self.center.check("the centre of an ellipse")?;
        check_point(&still(self.along), "the first axis of an ellipse")?;
        check_direction(&still(self.along), "the first axis of an ellipse", 2)?;
        check_different([self.particle].into_iter().chain(self.center.particle()), "an ellipse")?;
        self.half.iter().try_for_each(|half| check_radius(half, "half an axis of an ellipse"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_without_a_meaning_is_refused() {
        let [a, b] = [0, 1].map(ParticleId);
        let x = [1.0, 0.0, 0.0];
        assert!(OnEllipse::new(a, b, x, [2.0, 1.0]).check().is_ok());
        assert!(OnEllipse::new(a, a, x, [2.0, 1.0]).check().is_err(), "a particle about itself");
        assert!(OnEllipse::new(a, b, [0.0, 0.0, 1.0], [2.0, 1.0]).check().is_err(), "no direction in the plane");
        assert!(OnEllipse::new(a, [f64::NAN, 0.0, 0.0], x, [2.0, 1.0]).check().is_err(), "a centre that is NaN");
        for wrong in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert!(OnEllipse::new(a, b, x, [wrong, 1.0]).check().is_err(), "half an axis of {wrong}");
            assert!(OnEllipse::new(a, b, x, [2.0, wrong]).check().is_err(), "half an axis of {wrong}");
        }
        assert!(OnEllipse::new(a, b, x, [2.0, 1.0]).fits(3).is_err(), "in space");
    }
}
