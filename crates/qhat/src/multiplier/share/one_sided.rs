//! Ropes, struts and contacts among rows that repeat each other: their λ must not be negative.
//!
//! The share without signs gives displacements u, and x = B u. Rows that can only push or only pull make the truss a
//! piecewise linear one, and its displacements the minimum of a convex function:
//!
//! ```text
//! φ(u) = ½ Σ (b_i·u)² + ½ Σ_one-sided max(0, b_i·u)² − F·u,   x_i = b_i·u, or max(0, b_i·u)
//! ```
//!
//! φ is quadratic wherever the same rows carry. Newton's method takes a step to the minimum of that quadratic, the
//! truss without the rows that carry nothing, and searches along the step for the least φ; it ends at the exact minimum
//! after finitely many steps. Source: Pang, Newton's method for B-differentiable equations, Mathematics of Operations
//! Research 15 (1990).
//!
//! φ has no minimum where no x with these signs balances F. The signs then stay as they are.

use super::component::{Component, Numbers};
use super::range::{dot, largest};

/// Newton steps until no more signs are sought. Each step changes the rows that carry; trusses take three to six.
const STEPS: usize = 50;

/// Part of the largest x below which a negative x is roundoff, and becomes zero.
const NO_FORCE: f64 = 1e-12;

/// Rounds of the share over the rods alone, which may turn the sign of a row that is not a rod.
const ROUNDS: usize = 10;

impl Component {
    /// The share with x_i ≥ 0 for the rows named, from `x`, the share without signs.
    pub(super) fn with_signs<const D: usize>(
        &self,
        numbers: &mut Numbers,
        force: &[f64],
        self_stress: &[bool],
        one_sided: &[usize],
        x: Vec<f64>,
    ) -> Vec<f64> {
        let is_wrong = |x: &[f64]| {
            let no_force = NO_FORCE * largest(x);
            one_sided.iter().any(|&i| x[i] < -no_force)
        };
        let clean = |mut x: Vec<f64>| {
            one_sided.iter().for_each(|&i| x[i] = x[i].max(0.0));
            x
        };
        if !is_wrong(&x) {
            return clean(x);
        }
        let whole = numbers.b.clone();
        let mut best = None;
        if let Some(mut carries) = self.carrying::<D>(numbers, &whole, force, one_sided) {
            for _ in 0..ROUNDS {
                self.keep::<D>(numbers, &whole, one_sided, &carries);
                if numbers.displacements.factor::<D>(self, &numbers.b).is_none() {
                    break;
                }
                let x = self.least::<D>(numbers, force, self_stress);
                if !is_wrong(&x) {
                    best = Some(x);
                    break;
                }
                for (carries, &i) in carries.iter_mut().zip(one_sided) {
                    *carries &= x[i] >= 0.0;
                }
            }
        }
        numbers.b = whole;
        // Bᵀx = F is what the force needs, and it is met by the share without signs.
        best.map_or(x, clean)
    }

    /// B ← B with zeros for the one-sided rows that carry nothing.
    fn keep<const D: usize>(&self, numbers: &mut Numbers, whole: &[f64], one_sided: &[usize], carries: &[bool]) {
        for (&i, &carries) in one_sided.iter().zip(carries) {
            let blocks = self.blocks(i);
            let part = blocks.start * D..blocks.end * D;
            if carries {
                numbers.b[part.clone()].copy_from_slice(&whole[part]);
            } else {
                numbers.b[part].fill(0.0);
            }
        }
    }

    /// For each one-sided row whether it carries at the minimum of φ; `None` where φ has none.
    fn carrying<const D: usize>(
        &self,
        numbers: &mut Numbers,
        whole: &[f64],
        force: &[f64],
        one_sided: &[usize],
    ) -> Option<Vec<bool>> {
        let mut is_one_sided = vec![false; self.row_count()];
        one_sided.iter().for_each(|&i| is_one_sided[i] = true);
        let stretched = |u: &[f64]| {
            let mut stretch = vec![0.0; self.row_count()];
            self.multiply::<D>(whole, u, &mut stretch);
            stretch
        };
        let pulling = |stretch: &[f64]| -> Vec<bool> { one_sided.iter().map(|&i| stretch[i] > 0.0).collect() };
        let mut u = vec![0.0; force.len()];
        let mut stretch = stretched(&u);
        let mut carries = vec![true; one_sided.len()];
        for _ in 0..STEPS {
            self.keep::<D>(numbers, whole, one_sided, &carries);
            numbers.displacements.factor::<D>(self, &numbers.b)?;
            let mut target = force.to_vec();
            numbers.displacements.solve(&mut target);
            let further = stretched(&target);
            if pulling(&further) == carries {
                return Some(carries);
            }
            let d: Vec<f64> = target.iter().zip(&u).map(|(target, u)| target - u).collect();
            let along: Vec<f64> = further.iter().zip(&stretch).map(|(further, stretch)| further - stretch).collect();
            let step = least_along(&stretch, &along, &is_one_sided, dot(force, &d))?;
            u.iter_mut().zip(&d).for_each(|(u, d)| *u += step * d);
            stretch.iter_mut().zip(&along).for_each(|(stretch, along)| *stretch += step * along);
            carries = pulling(&stretch);
        }
        None
    }
}

/// The t > 0 at which φ(u + t d) is least, from B u, B d and F·d; `None` where φ falls without end.
fn least_along(stretch: &[f64], along: &[f64], is_one_sided: &[bool], work: f64) -> Option<f64> {
    // φ' = slope + t curvature between two places at which a row begins or ceases to carry.
    let (mut slope, mut curvature) = (-work, 0.0);
    let mut turns: Vec<(f64, usize)> = Vec::new();
    for (i, (&stretch, &along)) in stretch.iter().zip(along).enumerate() {
        let carries = !is_one_sided[i] || stretch > 0.0 || (stretch == 0.0 && along > 0.0);
        if carries {
            slope += stretch * along;
            curvature += along * along;
        }
        let turn = -stretch / along;
        if is_one_sided[i] && turn.is_finite() && turn > 0.0 {
            turns.push((turn, i));
        }
    }
    turns.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (turn, i) in turns {
        if slope + turn * curvature >= 0.0 {
            break;
        }
        let sign = if along[i] > 0.0 { 1.0 } else { -1.0 };
        slope += sign * stretch[i] * along[i];
        curvature += sign * along[i] * along[i];
    }
    let step = -slope / curvature;
    (step.is_finite() && step > 0.0).then_some(step)
}
