//! TorsionSpring: a damped torsion spring at a hinge b between the arms to a and c.
//!
//! ```text
//! u = x_a − x_b,   w = x_c − x_b,   θ from u to w          [m, rad]
//! V = ½ k Δ²,   Δ = θ − θ₀                                  [J]
//! F = −(k Δ + kd θ̇) ∇θ,   θ̇ = ∇θ · v                        [N]
//! power of the damper = −kd θ̇²                              [W]
//! −∂F/∂q = k ∇θ∇θᵀ + (k Δ + kd θ̇) ∇²θ + kd ∇θ (∇²θ v)ᵀ,   −∂F/∂q̇ = kd ∇θ∇θᵀ
//! ```
//!
//! In the plane θ is signed, positive counter-clockwise. u is turned by θ₀ first, so that Δ lies in (−π, π]. The arms
//! may therefore pass through the straight position; V has a kink only at Δ = π. With ⊥(x, y) = (−y, x):
//!
//! ```text
//! ∂θ/∂u = −⊥u/|u|²,   ∂θ/∂w = ⊥w/|w|²,   ∂²θ/∂u∂w = 0
//! ∂²θ/∂w² = −[ŵ ŵ⊥ᵀ + ŵ⊥ ŵᵀ]/|w|²,   ∂²θ/∂u² = [û û⊥ᵀ + û⊥ ûᵀ]/|u|²
//! ```
//!
//! In space θ is unsigned, in [0, π]. n_u and n_w are the unit vectors at right angles to each arm, towards the other
//! arm; m is the unit vector at right angles to both arms:
//!
//! ```text
//! ∂θ/∂u = −n_u/|u|,   ∂²θ/∂u² = [û n_uᵀ + n_u ûᵀ + cot θ mmᵀ]/|u|²,   ∂²θ/∂u∂w = −mmᵀ/(sin θ |u||w|); ∂²θ/∂w² likewise
//! ```
//!
//! Straight (θ = π) or folded (θ = 0) arms in space have no n. If the rest angle θ₀ is the same π or 0, the limit is an
//! isotropic spring, for which any n is correct. Otherwise the force is finite near this position and is taken as zero
//! at it. An arm of length zero has no angle: the force is zero, and V is the value at θ = 0. Near this position the
//! force grows as 1/|u|.

use super::{Acts, Dependence, ForceError};
use crate::allowed::{finite, not_negative};
use crate::linalg::block::{Block, diagonal, outer, plus, times, zero};
use crate::point::{Motion, Point, add, dot, minus, norm, scaled};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;
use std::f64::consts::PI;

/// Damped torsion spring at a hinge between two arms.
#[derive(Clone, Debug, PartialEq)]
pub struct TorsionSpring {
    /// The end of the first arm.
    pub a: ParticleId,
    /// The hinge.
    pub b: ParticleId,
    /// The end of the second arm.
    pub c: ParticleId,
    /// k [N·m/rad], not negative.
    pub stiffness: f64,
    /// kd [N·m·s/rad], not negative.
    pub damping: f64,
    /// θ₀ \[rad\]: −π to π in the plane, counter-clockwise from the first arm to the second; 0 to π in space. π is
    /// straight.
    pub angle: f64,
}

/// One arm: its direction, its length, the unit vector across it along which θ changes most, and the sign of this
/// change.
struct Arm<const D: usize> {
    along: Point<D>,
    length: f64,
    across: Point<D>,
    sign: f64,
}

impl<const D: usize> Arm<D> {
    /// ∂θ/∂(its end).
    fn gradient(&self) -> Point<D> {
        scaled(self.sign / self.length, self.across)
    }

    /// The part of ∂²θ/∂(its end)² within the plane of both arms.
    fn curvature(&self) -> Block<D> {
        let s = -self.sign / (self.length * self.length);
        plus(outer(s, self.along, self.across), s, outer(1.0, self.across, self.along))
    }
}

/// The hinge at one motion: Δ, both arms, and of bending out of the plane of the arms Δ/sin θ (`by_sine`), Δ cot θ
/// (`by_tangent`), 1/sin θ and cot θ. These four are zero in two dimensions, the last two also with arms in line.
struct Bend<const D: usize> {
    delta: f64,
    u: Arm<D>,
    w: Arm<D>,
    by_sine: f64,
    by_tangent: f64,
    cosecant: f64,
    cotangent: f64,
}

impl TorsionSpring {
    fn bend<const D: usize>(&self, motion: Motion<'_, D>) -> Option<Bend<D>> {
        let hinge = motion.x(self.b);
        let (u, w) = (minus(motion.x(self.a), hinge), minus(motion.x(self.c), hinge));
        let lengths = (norm(u), norm(w));
        if lengths.0 == 0.0 || lengths.1 == 0.0 {
            return None;
        }
        let (u, w) = ((scaled(1.0 / lengths.0, u), lengths.0), (scaled(1.0 / lengths.1, w), lengths.1));
        if D == 2 { Some(self.bend_in_plane(u, w)) } else { self.bend_in_space(u, w) }
    }

    fn bend_in_plane<const D: usize>(&self, u: (Point<D>, f64), w: (Point<D>, f64)) -> Bend<D> {
        let turned = |a: Point<D>| std::array::from_fn(|k| if k == 0 { -a[1] } else { a[0] });
        let (sine, cosine) = libm::sincos(self.angle);
        let from = plus_scaled(scaled(cosine, u.0), sine, turned(u.0));
        let delta = libm::atan2(from[0] * w.0[1] - from[1] * w.0[0], dot(from, w.0));
        let arm = |(along, length), sign| Arm { along, length, across: turned(along), sign };
        Bend { delta, u: arm(u, -1.0), w: arm(w, 1.0), by_sine: 0.0, by_tangent: 0.0, cosecant: 0.0, cotangent: 0.0 }
    }

    fn bend_in_space<const D: usize>(&self, u: (Point<D>, f64), w: (Point<D>, f64)) -> Option<Bend<D>> {
        let cosine = dot(u.0, w.0);
        let (towards_w, towards_u) = (plus_scaled(w.0, -cosine, u.0), plus_scaled(u.0, -cosine, w.0));
        let sine = norm(towards_w);
        let delta = libm::atan2(sine, cosine) - self.angle;
        let arm = |(along, length), across| Arm { along, length, across, sign: -1.0 };
        let other = norm(towards_u);
        if sine > 0.0 && other > 0.0 {
            let (n_u, n_w) = (scaled(1.0 / sine, towards_w), scaled(1.0 / other, towards_u));
            let by_sine = delta / sine;
            let (cosecant, cotangent) = (1.0 / sine, cosine / sine);
            let (u, w) = (arm(u, n_u), arm(w, n_w));
            return Some(Bend { delta, u, w, by_sine, by_tangent: by_sine * cosine, cosecant, cotangent });
        }
        if delta != 0.0 {
            return None;
        }
        // Any direction across is correct. It is made from the axis along which the arm has its smallest component.
        let least = (1..D).fold(0, |least, k| if u.0[k].abs() < u.0[least].abs() { k } else { least });
        let axis: Point<D> = std::array::from_fn(|k| if k == least { 1.0 } else { 0.0 });
        let n = plus_scaled(axis, -dot(axis, u.0), u.0);
        let n = scaled(1.0 / norm(n), n);
        // (θ − θ₀)/sin θ tends to cos θ, which is 1 or −1.
        let side = if cosine > 0.0 { 1.0 } else { -1.0 };
        let (u, w) = (arm(u, n), arm(w, scaled(-side, n)));
        Some(Bend { delta, u, w, by_sine: side, by_tangent: 1.0, cosecant: 0.0, cotangent: 0.0 })
    }

    /// ∂θ/∂x_a, ∂θ/∂x_b, ∂θ/∂x_c, with the particles.
    fn gradient<const D: usize>(&self, bend: &Bend<D>) -> [(ParticleId, Point<D>); 3] {
        let (a, c) = (bend.u.gradient(), bend.w.gradient());
        [(self.a, a), (self.b, scaled(-1.0, plus_scaled(a, 1.0, c))), (self.c, c)]
    }

    /// The blocks of s ∇²θ, from s, s cot θ and s/sin θ: the products are finite with arms in line, where cot θ and
    /// 1/sin θ alone are not.
    fn curvature<const D: usize>(
        &self,
        bend: &Bend<D>,
        s: f64,
        [by_tangent, by_sine]: [f64; 2],
    ) -> [(ParticleId, ParticleId, Block<D>); 6] {
        let (u, w) = (&bend.u, &bend.w);
        let (mut uu, mut ww, mut uw) = (zero(), zero(), zero());
        uu = plus(uu, s, u.curvature());
        ww = plus(ww, s, w.curvature());
        if D == 3 {
            // m mᵀ = I − û ûᵀ − n_u n_uᵀ.
            let mm = plus(diagonal(1.0), -1.0, outer(1.0, u.along, u.along));
            let mm = plus(mm, -1.0, outer(1.0, u.across, u.across));
            uu = plus(uu, by_tangent / (u.length * u.length), mm);
            ww = plus(ww, by_tangent / (w.length * w.length), mm);
            uw = plus(uw, -by_sine / (u.length * w.length), mm);
        }
        let minus_sum = |one: Block<D>, other: Block<D>| plus(plus(zero(), -1.0, one), -1.0, other);
        let (ub, bw) = (minus_sum(uu, uw), minus_sum(uw, ww));
        let hinge = minus_sum(ub, bw);
        [
            (self.a, self.a, uu),
            (self.a, self.b, ub),
            (self.a, self.c, uw),
            (self.b, self.b, hinge),
            (self.b, self.c, bw),
            (self.c, self.c, ww),
        ]
    }

    fn rate<const D: usize>(motion: Motion<'_, D>, gradient: &[(ParticleId, Point<D>); 3]) -> f64 {
        gradient.iter().map(|&(id, g)| dot(g, motion.v(id))).sum()
    }
}

/// a + s b.
fn plus_scaled<const D: usize>(a: Point<D>, s: f64, b: Point<D>) -> Point<D> {
    std::array::from_fn(|k| a[k] + s * b[k])
}

impl Acts for TorsionSpring {
    fn add<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64], Q: &mut [f64]) {
        let Some(bend) = self.bend(motion) else { return };
        let gradient = self.gradient(&bend);
        let torque = -(self.stiffness * bend.delta + self.damping * Self::rate(motion, &gradient));
        for (id, g) in gradient {
            add(Q, id, scaled(torque, g));
        }
    }

    fn potential<const D: usize>(&self, motion: Motion<'_, D>, _: &[f64]) -> f64 {
        let hinge = motion.x(self.b);
        let (u, w) = (minus(motion.x(self.a), hinge), minus(motion.x(self.c), hinge));
        let delta = match self.bend(motion) {
            Some(bend) => bend.delta,
            None if norm(u) > 0.0 && norm(w) > 0.0 && dot(u, w) < 0.0 => PI - self.angle,
            None => self.angle,
        };
        0.5 * self.stiffness * delta * delta
    }

    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let Some(bend) = self.bend(motion) else { return 0.0 };
        let rate = Self::rate(motion, &self.gradient(&bend));
        -self.damping * rate * rate
    }

    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
        let Some(bend) = self.bend(motion) else { return };
        let (u, w) = (1.0 / bend.u.length, 1.0 / bend.w.length);
        let torque = self.stiffness * bend.delta.abs();
        let aside = self.stiffness * (bend.by_sine.abs() + bend.by_tangent.abs());
        // |∇θ| is u and w at the ends and at most u + w at the hinge. A row sums the products with all three, at most
        // 2 (u + w).
        let all = 2.0 * (u + w);
        for (id, most) in [(self.a, u), (self.b, u + w), (self.c, w)] {
            bound(id, most * all * (self.stiffness + torque + aside), most * all * self.damping);
        }
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
        let Some(bend) = self.bend(motion) else { return };
        let gradient = self.gradient(&bend);
        let along = self.stiffness + rate * self.damping;
        for (i, &(first, g)) in gradient.iter().enumerate() {
            for &(second, other) in &gradient[i..] {
                visit(first, second, Stiffness::Definite(outer(along, g, other)));
            }
        }
        // The damper also depends on q through ∇θ. This part is not symmetric and is left out; Newton's method
        // converges without it.
        let torque = self.stiffness * bend.delta + self.damping * Self::rate(motion, &gradient);
        let aside = [self.stiffness * bend.by_tangent, self.stiffness * bend.by_sine];
        for (first, second, block) in self.curvature(&bend, torque, aside) {
            visit(first, second, Stiffness::Indefinite(block));
        }
    }

    fn linearize<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
    ) {
        let Some(bend) = self.bend(motion) else { return };
        let gradient = self.gradient(&bend);
        let rate = Self::rate(motion, &gradient);
        // ∇²θ v, from the blocks of ∇²θ.
        let mut turning = gradient.map(|(id, _)| (id, [0.0; D]));
        let curvature = self
            .curvature(&bend, 1.0, [bend.cotangent, bend.cosecant])
            .map(|(first, second, block)| (first, second, Stiffness::Indefinite(block)));
        for (first, second, block) in &curvature {
            block.blocks((*first, *second), &mut |row, column, block| {
                for (_, sum) in turning.iter_mut().filter(|(id, _)| *id == row) {
                    *sum = plus_scaled(*sum, 1.0, times(&block, motion.v(column)));
                }
            });
        }
        for (i, g) in gradient {
            for ((j, other), (_, turning)) in gradient.into_iter().zip(turning) {
                let slope = plus_scaled(scaled(self.stiffness, other), self.damping, turning);
                visit(i, j, outer(1.0, g, slope), outer(self.damping, g, other));
            }
        }
        let damper = self.damping * rate;
        let aside = [
            self.stiffness * bend.by_tangent + damper * bend.cotangent,
            self.stiffness * bend.by_sine + damper * bend.cosecant,
        ];
        for (first, second, block) in self.curvature(&bend, self.stiffness * bend.delta + damper, aside) {
            Stiffness::Indefinite(block).blocks((first, second), &mut |row, column, block| {
                visit(row, column, block, zero());
            });
        }
    }

    fn particles(&self) -> Vec<ParticleId> {
        vec![self.a, self.b, self.c]
    }

    fn check(&self) -> Result<(), ForceError> {
        not_negative("the stiffness of a torsion spring", self.stiffness)?;
        not_negative("the damping of a torsion spring", self.damping)?;
        finite("the rest angle of a torsion spring", self.angle)?;
        if self.angle.abs() > PI {
            return Err(ForceError::RestAngle { angle: self.angle });
        }
        let differ = self.a != self.b && self.b != self.c && self.c != self.a;
        if differ { Ok(()) } else { Err(ForceError::TorsionParticles) }
    }
}
