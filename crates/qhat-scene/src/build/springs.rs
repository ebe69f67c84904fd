//! `[[springs]]`, and the springs of `[[loads]]`.

use super::Assembly;
use crate::model::Spring;
use crate::model::springs::{CubicSpring, TorsionSpring};
use crate::tree::Node;
use qhat::ParticleId;
use std::f64::consts::PI;

impl Assembly<'_, '_, '_> {
    pub(super) fn add_springs(&mut self, springs: &[Spring]) {
        for (index, it) in springs.iter().enumerate() {
            let place = self.tree.key("springs").item(index);
            let before = self.builder.force_count();
            self.add_spring(it, place);
            self.made.springs.push(before..self.builder.force_count());
        }
    }

    fn add_spring(&mut self, it: &Spring, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let rest = self.rest(it.rest, (a, b), place)?;
        let Spring { stiffness, damping, .. } = *it;
        self.builder.force(qhat::Spring { a, b, stiffness, damping, rest });
        Some(())
    }

    pub(super) fn add_cubic_spring(&mut self, it: &CubicSpring, place: &Node) -> Option<()> {
        let (a, b) = self.pair(&it.between, place.key("between"))?;
        let rest = self.rest(it.rest, (a, b), place)?;
        let CubicSpring { stiffness, cubic, damping, .. } = *it;
        self.builder.force(qhat::CubicSpring { a, b, stiffness, cubic, damping, rest });
        Some(())
    }

    /// The rest length of a spring [m]: as given, else the distance at the start.
    fn rest(&mut self, given: Option<f64>, (a, b): (ParticleId, ParticleId), place: &Node) -> Option<f64> {
        let rest = given.unwrap_or_else(|| self.distance(a, b));
        if !rest.is_finite() {
            let message = "the ends of this spring start too far apart to measure its rest length";
            self.report.error(place.key("between").span.clone(), message, Some("give `rest` [m]".into()));
            return None;
        }
        Some(rest)
    }

    pub(super) fn add_torsion_spring(&mut self, it: &TorsionSpring, place: &Node) -> Option<()> {
        let [a, b, c] = self.different(&it.arms, place.key("arms"))?[..] else { return None };
        let angle = match it.angle {
            Some(angle) if self.dimension == 3 && angle < 0.0 => {
                let message = "there is no negative angle in three dimensions";
                let help = "give the angle between the two arms, 0 to π".to_owned();
                self.report.error(place.key("angle").span.clone(), message, Some(help));
                return None;
            }
            Some(angle) => angle,
            None => self.hinge_angle(a, b, c).or_else(|| {
                let message = "an arm of this hinge has no length at the start, and so no angle";
                let help = "move its particles apart, or give `angle` [rad]".to_owned();
                self.report.error(place.key("arms").span.clone(), message, Some(help));
                None
            })?,
        };
        let (stiffness, damping) = (it.stiffness, it.damping);
        self.builder.force(qhat::TorsionSpring { a, b, c, stiffness, damping, angle });
        Some(())
    }

    /// The angle at the start from the arm b–a to the arm b–c [rad].
    fn hinge_angle(&self, a: ParticleId, b: ParticleId, c: ParticleId) -> Option<f64> {
        let (d, q) = (self.dimension, self.start_positions());
        let arm = |end: ParticleId| -> [f64; 3] {
            let of = |k: usize| q[end.index() * d + k] - q[b.index() * d + k];
            std::array::from_fn(|k| if k < d { of(k) } else { 0.0 })
        };
        let dot = |u: [f64; 3], w: [f64; 3]| u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
        let (u, w) = (arm(a), arm(c));
        let normal = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
        let across = if d == 2 { normal[2] } else { dot(normal, normal).sqrt() };
        let measurable = dot(u, u) > 0.0 && dot(w, w) > 0.0 && dot(u, w).is_finite() && across.is_finite();
        // Rounding may leave an angle an ulp beyond π.
        measurable.then(|| libm::atan2(across, dot(u, w)).clamp(-PI, PI))
    }
}
