//! Of a family of λ, the one whose forces at contacts leave the round cones of friction least.
//!
//! ```text
//! least  ½ Σ_k d_k²(λ + Σ_j z_j v_j) + ½ η |z|²
//! d_k: distance [N] of the force of contact k from its cone, |λ_t| ≤ μ λ_n, or from λ_n ≥ 0 where it has no friction
//! ```
//!
//! Where forces within all cones exist, the ones nearest to λ are found, off by η of it. Where none exist, all contacts
//! share the distance, which grows evenly from zero with the load that no cone holds. So the distance can be an event
//! function.
//!
//! The function is convex, and quadratic, but for the curvature of the cones, where the same contacts are outside.
//! Method: Newton's, with the least along each step. Source: Qi, Sun, A nonsmooth version of Newton's method,
//! Mathematical Programming 58 (1993).

use super::friction::eliminate;

/// η: forces stay outside of their cones by about this part of them. Contacts count as outside from 1e-10 of them
/// (`contact/roundoff.rs`).
const NEAREST: f64 = 1e-12;

/// Part of the forces below which the gradient is zero: roundoff of distances.
const FLAT: f64 = 4.0 * f64::EPSILON;

/// Newton steps. Problems of three feet take three to eight.
const STEPS: usize = 40;

/// Halvings of a step to the place where the function is least along it.
const HALVINGS: usize = 50;

/// A contact of the family: the force λ and its parts v_j, in the normal and two tangential directions.
#[derive(Clone, Debug)]
pub(super) struct Member {
    /// μ, zero for a contact that has no tangential force.
    pub(super) friction: f64,
    /// [N].
    pub(super) force: [f64; 3],
    /// For each j [N].
    pub(super) parts: Vec<[f64; 3]>,
}

/// The contribution of one contact outside of its cone to the gradient and to the Hessian.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Outside {
    /// The shortest vector from the cone to the force.
    from_cone: [f64; 3],
    /// Directions u and weights c with ∂ from_cone/∂ force = Σ c u uᵀ.
    curvature: [([f64; 3], f64); 3],
}

/// The vector from the cone |t| ≤ μ n to a force (n, t); `None` within the cone.
fn outside(friction: f64, [n, a, b]: [f64; 3]) -> Option<Outside> {
    let t = (a * a + b * b).sqrt();
    if n >= 0.0 && t <= friction * n {
        return None;
    }
    if friction * t <= -n {
        // The nearest point is the apex.
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| (axis, 1.0));
        return Some(Outside { from_cone: [n, a, b], curvature: axes });
    }
    let across = (1.0 + friction * friction).sqrt();
    let distance = (t - friction * n) / across;
    let d = [a / t, b / t];
    let normal = [-friction / across, d[0] / across, d[1] / across];
    let bend = distance / (t * across);
    let curvature = [(normal, 1.0), ([0.0, -d[1], d[0]], bend), ([0.0; 3], 0.0)];
    Some(Outside { from_cone: normal.map(|u| distance * u), curvature })
}

/// z, one number for each v_j.
pub(super) fn least_outside(members: &[Member], count: usize) -> Vec<f64> {
    let mut z = vec![0.0; count];
    let size = members.iter().flat_map(|member| member.force).fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut slope = gradient(members, &z);
    for _ in 0..STEPS {
        if slope.iter().all(|slope| slope.abs() <= FLAT * size) {
            break;
        }
        let mut hessian = hessian(members, &z);
        let mut step: Vec<f64> = slope.iter().map(|slope| -slope).collect();
        eliminate(&mut hessian, &mut step);
        if step.iter().any(|step| !step.is_finite()) {
            break;
        }
        let along = |part: f64| -> Vec<f64> { z.iter().zip(&step).map(|(z, step)| z + part * step).collect() };
        let rises = |part: f64| dot(&gradient(members, &along(part)), &step) > 0.0;
        let mut part = 1.0;
        if rises(1.0) {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if rises(middle) { &mut high } else { &mut low }) = middle;
            }
            part = low;
        }
        let next = along(part);
        if next == z {
            break;
        }
        z = next;
        slope = gradient(members, &z);
    }
    z
}

fn force(member: &Member, z: &[f64]) -> [f64; 3] {
    let mut force = member.force;
    for (part, z) in member.parts.iter().zip(z) {
        force.iter_mut().zip(part).for_each(|(force, part)| *force += z * part);
    }
    force
}

fn gradient(members: &[Member], z: &[f64]) -> Vec<f64> {
    let mut slope: Vec<f64> = z.iter().map(|z| NEAREST * z).collect();
    for member in members {
        let Some(Outside { from_cone, .. }) = outside(member.friction, force(member, z)) else { continue };
        slope.iter_mut().zip(&member.parts).for_each(|(slope, part)| *slope += dot(&from_cone, part));
    }
    slope
}

fn hessian(members: &[Member], z: &[f64]) -> Vec<f64> {
    let n = z.len();
    let mut H = vec![0.0; n * n];
    (0..n).for_each(|j| H[j * n + j] = NEAREST);
    for member in members {
        let Some(Outside { curvature, .. }) = outside(member.friction, force(member, z)) else { continue };
        for (u, weight) in curvature.iter().filter(|(_, weight)| *weight != 0.0) {
            let along: Vec<f64> = member.parts.iter().map(|part| dot(u, part)).collect();
            for i in 0..n {
                (0..n).for_each(|j| H[i * n + j] += weight * along[i] * along[j]);
            }
        }
    }
    H
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two feet that a rod presses apart or together, z its force, under a push along the rod at the first.
    fn feet(push: f64, loads: [f64; 2]) -> [Member; 2] {
        let member = |force: [f64; 3], part: f64| Member { friction: 0.5, force, parts: vec![[0.0, part, 0.0]] };
        [member([loads[0], push, 0.0], -1.0), member([loads[1], 0.0, 0.0], 1.0)]
    }

    fn off(members: &[Member], z: &[f64]) -> Vec<f64> {
        let from = |member: &Member| outside(member.friction, force(member, z)).map_or([0.0; 3], |out| out.from_cone);
        members.iter().map(from).map(|v| dot(&v, &v).sqrt()).collect()
    }

    #[test]
    fn forces_within_all_cones_are_found_where_there_are_any() {
        // Friction of at most 0.5 + 2 holds 2.4: the second foot takes 1.9 at least.
        let members = feet(2.4, [1.0, 4.0]);
        let z = least_outside(&members, 1);
        assert!((z[0] - 1.9).abs() < 1e-9, "{z:?}");
        assert!(off(&members, &z).iter().all(|off| *off < 1e-10), "{:?}", off(&members, &z));
        // A push that the first foot holds alone stays there.
        assert_eq!(least_outside(&feet(0.4, [1.0, 4.0]), 1), [0.0]);
    }

    #[test]
    fn a_load_that_no_cone_holds_is_shared_and_grows_from_zero() {
        for beyond in [1e-6, 1e-3, 0.1] {
            let members = feet(2.5 + beyond, [1.0, 4.0]);
            let off = off(&members, &least_outside(&members, 1));
            let share = 0.5 * beyond / 1.25_f64.sqrt();
            assert!(off.iter().all(|off| (off - share).abs() < 1e-9 * (1.0 + share)), "{off:?}, expected {share}");
        }
    }

    #[test]
    fn a_contact_without_friction_does_not_pull() {
        let pulled = Member { friction: 0.0, force: [-1.0, 0.0, 0.0], parts: vec![[1.0, 0.0, 0.0]] };
        let pressed = Member { friction: 0.3, force: [2.0, 0.0, 0.0], parts: vec![[-1.0, 0.2, 0.1]] };
        let members = [pulled, pressed];
        let z = least_outside(&members, 1);
        assert!((z[0] - 1.0).abs() < 1e-9, "{z:?}");
    }
}
