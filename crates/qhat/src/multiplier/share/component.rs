//! The share of one connected component.
//!
//! Rows are scaled so that every number is the square root of an energy, up to a factor:
//!
//! ```text
//! b_i = √s_i J_i/|J_i|,   x_i = λ_i |J_i|/√s_i      s_i = EA/L of rods [N/m], ρ of other rows
//! F = Bᵀ x,   least |x|²:   x = B u,   (Bᵀ B) u = F
//! ```
//!
//! u are the displacements [m] of an elastic truss under F: the displacement method. |J_i| is the force of λ_i = 1 [N];
//! of rods the tension. ρ, a stiffness of the other rows, plays no part in the result: conjugate gradients in the null
//! space of Bᵀ take x from the least |x|² to the least Σ x_i² over the rods alone,
//!
//! ```text
//! least |R x|²,   x ∈ x⁰ + null(Bᵀ),   gradient Π R x        R keeps the rods,  Π = I − B (BᵀB)⁺ Bᵀ
//! ```
//!
//! and leave that part of x alone which no rod has a part in. This part keeps its least norm.
//!
//! λ_i is unique if and only if every vector of the null space of Bᵀ, a state of self-stress, is zero at i. Π v of
//! a generic v is nonzero wherever some vector of the null space is.

use super::displacements::Displacements;
use super::range::{PASSES, ROUNDOFF, add, dot, largest, least};
use super::{RightHandSide, RowsToShare};
use crate::constraint::Layout;
use crate::space::ParticleId;

/// ρ over the largest stiffness of a rod. Conjugate gradients converge faster for a larger ρ; the factor loses as
/// many digits as ρ has, which refinement must win back.
const STIFFER: f64 = 1e3;

/// |Π v|_i above which λ_i is not unique, for components of v of size 1. Roundoff leaves less than 1e-10 of a zero in
/// trusses of 3000 bays; a self-stress of that size would belong to stiffnesses that differ by 1e16.
const SELF_STRESS: f64 = 1e-8;

/// Pivot of K, scaled to a unit diagonal, above which nothing can move beyond doubt: a hundred times the shift that a
/// mechanism leaves. Cantilevers of n bays have pivots down to n⁻³, 4e-11 at 3000 bays.
const HELD: f64 = 1e-11;

/// Part of the largest force by which roundoff may change F = M q̈ − Q.
const IMPROVED: f64 = 1e-12;

/// Part of the largest rate by which J q̈ may be off where rows count as free of contradiction: the constraint
/// tolerance of redundant rows that are not multiples of each other, with a digit to spare.
const CONSISTENT: f64 = 1e-9;

/// One connected component: its rows, and their blocks on particles that can move.
#[derive(Clone, Debug)]
pub(super) struct Component {
    /// Its rows, ascending.
    rows: Vec<u32>,
    /// The blocks of each row: `start[i]..start[i + 1]`.
    pub(super) start: Vec<u32>,
    /// The place of each block in J, and its particle, numbered within the component.
    entry: Vec<u32>,
    pub(super) particle: Vec<u32>,
    /// The particles, as the system numbers them.
    pub(super) owner: Vec<u32>,
    numbers: Option<Box<Numbers>>,
}

/// The numbers of a component at one motion; made when first needed.
#[derive(Clone, Debug)]
pub(super) struct Numbers {
    pub(super) displacements: Displacements,
    /// B, D numbers for each block.
    pub(super) b: Vec<f64>,
    /// √s_i/|J_i|; zero for rows that take no part.
    pub(super) size: Vec<f64>,
    pub(super) is_rod: Vec<bool>,
    /// F.
    pub(super) force: Vec<f64>,
}

impl Component {
    pub(super) fn new(layout: &Layout, inverse_mass: &[f64], mut rows: Vec<u32>) -> Self {
        rows.sort_unstable();
        let (mut start, mut entry, mut owner) = (vec![0], Vec::new(), Vec::new());
        for &row in &rows {
            for e in layout.start[row as usize]..layout.start[row as usize + 1] {
                let ParticleId(particle) = layout.particle[e];
                if inverse_mass[particle] > 0.0 {
                    entry.push(e as u32);
                    owner.push(particle as u32);
                }
            }
            start.push(entry.len() as u32);
        }
        let mut known = owner.clone();
        known.sort_unstable();
        known.dedup();
        let particle = owner.iter().map(|particle| known.partition_point(|other| other < particle) as u32).collect();
        Component { rows, start, entry, particle, owner: known, numbers: None }
    }

    /// As [`super::Share::spread`], for the rows of the component.
    pub(super) fn spread<const D: usize>(
        &mut self,
        rows: &RowsToShare<'_>,
        lambda: &mut [f64],
        is_unique: &mut [bool],
    ) {
        let mut numbers = match self.numbers.take() {
            Some(numbers) => numbers,
            None => Box::new(self.make::<D>()),
        };
        self.scale::<D>(rows, &mut numbers);
        if let Some((x, self_stress)) = self.share::<D>(rows, &mut numbers) {
            let mut shared = rows.lambda.to_vec();
            for (i, &row) in self.rows.iter().enumerate().filter(|&(i, _)| self_stress[i]) {
                is_unique[row as usize] = false;
                shared[row as usize] = numbers.size[i] * x[i];
            }
            let own = rows.sticking.iter().filter(|contact| self.rows.binary_search(&(contact.normal as u32)).is_ok());
            let part = own.fold(1.0, |part, contact| contact.part(lambda, &shared, part));
            for &row in &self.rows {
                let (lambda, shared) = (&mut lambda[row as usize], shared[row as usize]);
                *lambda = if part == 1.0 { shared } else { *lambda + part * (shared - *lambda) };
            }
            // Rows that follow from others do so up to the constraint tolerance, and so does λ on the way.
            if part < 1.0 && numbers.displacements.factor::<D>(self, &numbers.b).is_some() {
                let (mut x, force) = (self.scaled(&numbers, lambda), std::mem::take(&mut numbers.force));
                self.balance::<D>(&mut numbers, &force, &mut x);
                numbers.force = force;
                let sizes = self.rows.iter().zip(&numbers.size);
                sizes.zip(x).for_each(|((&row, &size), x)| lambda[row as usize] = size * x);
            }
        }
        self.numbers = Some(numbers);
    }

    /// x of λ.
    fn scaled(&self, numbers: &Numbers, lambda: &[f64]) -> Vec<f64> {
        let rows = self.rows.iter().zip(&numbers.size);
        rows.map(|(&row, &size)| if size > 0.0 { lambda[row as usize] / size } else { 0.0 }).collect()
    }

    fn make<const D: usize>(&self) -> Numbers {
        Numbers {
            displacements: Displacements::new::<D>(self, self.owner.len()),
            b: vec![0.0; D * self.entry.len()],
            size: vec![0.0; self.rows.len()],
            is_rod: vec![false; self.rows.len()],
            force: vec![0.0; D * self.owner.len()],
        }
    }

    /// Writes B, and which rows are rods.
    fn scale<const D: usize>(&self, rows: &RowsToShare<'_>, numbers: &mut Numbers) {
        let J = rows.J;
        let Numbers { b, size, is_rod, .. } = numbers;
        let mut stiffest = 0.0_f64;
        for &row in self.rows.iter().filter(|&&row| rows.acts[row as usize]) {
            let flexibility = rows.flexibility[row as usize];
            stiffest = stiffest.max(if flexibility > 0.0 { 1.0 / flexibility } else { 0.0 });
        }
        let rho = if stiffest > 0.0 { STIFFER * stiffest } else { 1.0 };
        for (i, &row) in self.rows.iter().enumerate() {
            let row = row as usize;
            is_rod[i] = rows.flexibility[row] > 0.0;
            let blocks = self.blocks(i);
            let squares = |e: usize| J.blocks[e * D..(e + 1) * D].iter().map(|number| number * number).sum::<f64>();
            let gradient = if is_rod[i] {
                // Both blocks of a rod have the same size, and it is the tension that counts.
                squares(J.layout.start[row]).sqrt()
            } else {
                blocks.clone().map(|block| squares(self.entry[block] as usize)).sum::<f64>().sqrt()
            };
            let s = if is_rod[i] { 1.0 / rows.flexibility[row] } else { rho };
            let acts = rows.acts[row] && gradient > 0.0 && s.is_finite();
            size[i] = if acts { s.sqrt() / gradient } else { 0.0 };
            for block in blocks {
                let e = self.entry[block] as usize;
                for k in 0..D {
                    b[block * D + k] = size[i] * J.blocks[e * D + k];
                }
            }
        }
        // The friction of a sliding contact follows its normal force, and both balance F together.
        for contact in rows.sliding {
            let Ok(i) = self.rows.binary_search(&(contact.normal as u32)) else { continue };
            for (tangent, d) in contact.tangents.clone().zip(contact.slip.direction) {
                let behind = J.layout.start[tangent] - J.layout.start[contact.normal];
                for block in self.blocks(i) {
                    let e = self.entry[block] as usize + behind;
                    for k in 0..D {
                        b[block * D + k] -= size[i] * contact.friction * d * J.blocks[e * D + k];
                    }
                }
            }
        }
    }

    /// x of the share, and the rows whose λ is not unique; `None` where every λ is unique.
    fn share<const D: usize>(&self, rows: &RowsToShare<'_>, numbers: &mut Numbers) -> Option<(Vec<f64>, Vec<bool>)> {
        let smallest = numbers.displacements.factor::<D>(self, &numbers.b)?;
        let self_stress = self.self_stress::<D>(numbers)?;
        let at_hand = self.scaled(numbers, rows.lambda);
        let mut force = std::mem::take(&mut numbers.force);
        force.fill(0.0);
        self.add_transposed::<D>(&numbers.b, &at_hand, &mut force);
        if smallest > HELD && rows.sliding.is_empty() {
            self.improve_force::<D>(rows, numbers, smallest, &mut force);
        }
        let one_sided = (0..self.rows.len()).filter(|&i| self_stress[i] && rows.is_one_sided[self.rows[i] as usize]);
        let one_sided: Vec<usize> = one_sided.collect();
        let x = self.least::<D>(numbers, &force, &self_stress);
        let x = self.with_signs::<D>(numbers, &force, &self_stress, &one_sided, x);
        numbers.force = force;
        Some((x, self_stress))
    }

    /// F where the rows leave no particle any motion: the accelerations are those of the drives,
    /// J q̈ = −γ − ks C − kd Ċ, and F = M q̈ − Q. At rest F is −Q to the bit, whatever the masses are; Jᵀλ is exact
    /// only to as many roundoffs of the force on the lightest particle as the heaviest one is heavier.
    fn improve_force<const D: usize>(
        &self,
        rows: &RowsToShare<'_>,
        numbers: &mut Numbers,
        smallest: f64,
        force: &mut [f64],
    ) {
        let RightHandSide { bias, stiffness, damping, .. } = rows.rates;
        let rates = self.rows.iter().zip(&numbers.size).map(|(&row, size)| {
            let row = row as usize;
            size * (bias[row] + stiffness[row] + damping[row])
        });
        let rates: Vec<f64> = rates.collect();
        let mut target = vec![0.0; force.len()];
        self.add_transposed::<D>(&numbers.b, &rates, &mut target);
        let mut in_range = vec![0.0; rates.len()];
        let accelerations = self.balance::<D>(numbers, &target, &mut in_range);
        let (mut better, mut inertia) = (force.to_vec(), 0.0_f64);
        for (c, better) in better.iter_mut().enumerate() {
            let particle = self.owner[c / D] as usize;
            let push = accelerations[c] / rows.inverse_mass[particle];
            inertia = inertia.max(push.abs());
            *better = push - rows.applied[particle * D + c % D];
        }
        // A pivot divides the roundoff of q̈, and with it that of M q̈.
        let is_exact = f64::EPSILON * inertia <= IMPROVED * smallest * largest(&better);
        // Rows that contradict each other have no such accelerations, and F stays.
        let most = largest(&rates);
        let is_met = rates.iter().zip(&in_range).all(|(rate, met)| (rate - met).abs() <= CONSISTENT * most);
        if is_exact && is_met {
            force.copy_from_slice(&better);
        }
    }

    /// The rows that some state of self-stress is not zero at; `None` where there is no self-stress.
    fn self_stress<const D: usize>(&self, numbers: &mut Numbers) -> Option<Vec<bool>> {
        let acting = numbers.size.iter().enumerate();
        let v: Vec<f64> = acting.map(|(i, &size)| if size > 0.0 { generic(i) } else { 0.0 }).collect();
        let left = self.without_range::<D>(numbers, &v);
        let found: Vec<bool> = left.iter().map(|left| left.abs() > SELF_STRESS).collect();
        found.contains(&true).then_some(found)
    }

    /// x with Bᵀx = F: of all, the one with the least Σ x² over the rods; of those, the one with the least over the
    /// other rows. K is factored.
    pub(super) fn least<const D: usize>(&self, numbers: &mut Numbers, force: &[f64], self_stress: &[bool]) -> Vec<f64> {
        let mut x = vec![0.0; self.rows.len()];
        self.balance::<D>(numbers, force, &mut x);
        let is_rod = numbers.is_rod.clone();
        let others = self_stress.iter().zip(&is_rod).any(|(&stress, &is_rod)| stress && !is_rod);
        if !others || !is_rod.contains(&true) {
            return x;
        }
        let rods = |x: &[f64]| -> Vec<f64> {
            x.iter().zip(&is_rod).map(|(&x, &is_rod)| if is_rod { x } else { 0.0 }).collect()
        };
        let mut gradient = self.without_range::<D>(numbers, &rods(&x));
        let mut p: Vec<f64> = gradient.iter().map(|g| -g).collect();
        let mut slope = dot(&gradient, &gradient);
        let least = least(slope, &x);
        for _ in 0..PASSES {
            let along = self.without_range::<D>(numbers, &rods(&p));
            let curvature = dot(&p, &along);
            if slope <= least || curvature.is_nan() || curvature <= ROUNDOFF * dot(&p, &p) {
                break;
            }
            let step = slope / curvature;
            add(step, &p, &mut x);
            add(step, &along, &mut gradient);
            let last = std::mem::replace(&mut slope, dot(&gradient, &gradient));
            for (p, g) in p.iter_mut().zip(&gradient) {
                *p = slope / last * *p - g;
            }
        }
        self.balance::<D>(numbers, force, &mut x);
        x
    }

    pub(super) fn blocks(&self, i: usize) -> std::ops::Range<usize> {
        self.start[i] as usize..self.start[i + 1] as usize
    }

    /// The coordinates that a row depends on, and its numbers in B.
    pub(super) fn coordinates<const D: usize>(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        self.blocks(i).flat_map(move |block| (0..D).map(move |k| self.particle[block] as usize * D + k))
    }

    pub(super) fn numbers<'b, const D: usize>(&self, i: usize, b: &'b [f64]) -> impl Iterator<Item = f64> + 'b {
        let blocks = self.blocks(i);
        b[blocks.start * D..blocks.end * D].iter().copied()
    }

    pub(super) fn row_count(&self) -> usize {
        self.rows.len()
    }
}

/// The i-th of a sequence of numbers in ±[½, 1] without any pattern, so that no sum of few of them is zero by chance.
/// Source: Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA (2014).
fn generic(i: usize) -> f64 {
    let mut bits = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let size = 0.5 + 0.5 * (bits >> 12) as f64 / (1_u64 << 52) as f64;
    if bits & 1 == 0 { size } else { -size }
}
