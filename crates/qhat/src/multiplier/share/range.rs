//! The range of B and what lies across it, the space of self-stresses: products with B, balance with a force, and the
//! projection Π = I − B (BᵀB)⁺ Bᵀ.

use super::component::{Component, Numbers};

/// Bᵀx = F is met where it is off by a roundoff or two of the largest sum of its terms.
const MET: f64 = 4e-16;

/// Bᵀx = F is met as well as can be where refinement no longer helps below this.
const NEARLY_MET: f64 = 1e-13;

/// Refinement gains ten digits a pass where it converges.
const REFINEMENTS: usize = 4;

/// Curvature along a direction, relative, below which the direction is roundoff: it lies in no space in which conjugate
/// gradients search, and they must not follow it.
pub(super) const ROUNDOFF: f64 = 1e-9;

/// Conjugate gradients end after as many passes as there are eigenvalues far from 1; the limit ends them where roundoff
/// hides the end.
pub(super) const PASSES: usize = 40;

impl Component {
    /// Π v.
    pub(super) fn without_range<const D: usize>(&self, numbers: &mut Numbers, v: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; D * self.owner.len()];
        self.add_transposed::<D>(&numbers.b, v, &mut force);
        let mut in_range = vec![0.0; v.len()];
        self.balance::<D>(numbers, &force, &mut in_range);
        v.iter().zip(in_range).map(|(v, r)| v - r).collect()
    }

    /// Adds to x the shortest B u after which Bᵀx = F, and returns u.
    ///
    /// The factor is that of K + δ: refinement, x ← x + B (K + δ)⁻¹ (F − Bᵀx), shrinks the error by δ/(σ + δ) in the
    /// direction of an eigenvalue σ of K. Where a σ is about as small as δ, conjugate gradients go on (`complete`).
    pub(super) fn balance<const D: usize>(&self, numbers: &mut Numbers, force: &[f64], x: &mut [f64]) -> Vec<f64> {
        let mut u = vec![0.0; force.len()];
        let mut r = vec![0.0; force.len()];
        let mut w = vec![0.0; x.len()];
        let mut off = self.remainder::<D>(&numbers.b, force, x, &mut r);
        for _ in 0..REFINEMENTS {
            if off <= MET {
                return u;
            }
            numbers.displacements.solve(&mut r);
            self.multiply::<D>(&numbers.b, &r, &mut w);
            add(1.0, &w, x);
            add(1.0, &r, &mut u);
            let last = std::mem::replace(&mut off, self.remainder::<D>(&numbers.b, force, x, &mut r));
            if off > 0.5 * last {
                break;
            }
        }
        if off > NEARLY_MET {
            self.complete::<D>(numbers, &mut r, x, &mut u);
        }
        u
    }

    /// The rest of `balance` for a remainder r, by conjugate gradients for e, the rest of x:
    ///
    /// ```text
    /// G e = B (K + δ)⁻¹ r,   G = B (K + δ)⁻¹ Bᵀ,   r = Bᵀ e
    /// ```
    ///
    /// G has the eigenvalues σ/(σ + δ), nearly all of them 1. Roundoff of r in directions in which nothing holds has no
    /// part in any product, since B maps it to zero.
    fn complete<const D: usize>(&self, numbers: &mut Numbers, r: &mut [f64], x: &mut [f64], u: &mut [f64]) {
        let Numbers { displacements, b, .. } = numbers;
        // w = B z is what remains of the right side, p = B q the direction.
        let mut z = r.to_vec();
        displacements.solve(&mut z);
        let mut w = vec![0.0; x.len()];
        self.multiply::<D>(b, &z, &mut w);
        let (mut p, mut q, mut image) = (w.clone(), z.clone(), w.clone());
        let mut left = dot(&w, &w);
        let least = least(left, x);
        for _ in 0..PASSES {
            r.fill(0.0);
            self.add_transposed::<D>(b, &p, r);
            displacements.solve(r);
            self.multiply::<D>(b, r, &mut image);
            let curvature = dot(&p, &image);
            if left <= least || curvature.is_nan() || curvature <= ROUNDOFF * dot(&p, &p) {
                break;
            }
            let step = left / curvature;
            add(step, &p, x);
            add(step, &q, u);
            add(-step, &image, &mut w);
            add(-step, r, &mut z);
            let last = std::mem::replace(&mut left, dot(&w, &w));
            for (p, w) in p.iter_mut().zip(&w) {
                *p = left / last * *p + w;
            }
            for (q, z) in q.iter_mut().zip(&z) {
                *q = left / last * *q + z;
            }
        }
    }

    /// r ← F − Bᵀx, and its size in units of the largest sum of absolute values.
    fn remainder<const D: usize>(&self, b: &[f64], force: &[f64], x: &[f64], r: &mut [f64]) -> f64 {
        let mut sums: Vec<f64> = force.iter().map(|force| force.abs()).collect();
        r.copy_from_slice(force);
        for (i, &x) in x.iter().enumerate() {
            for block in self.blocks(i) {
                let first = self.particle[block] as usize * D;
                for k in 0..D {
                    let part = b[block * D + k] * x;
                    r[first + k] -= part;
                    sums[first + k] += part.abs();
                }
            }
        }
        let scale = largest(&sums);
        if scale > 0.0 { largest(r) / scale } else { 0.0 }
    }

    /// out = B u.
    pub(super) fn multiply<const D: usize>(&self, b: &[f64], u: &[f64], out: &mut [f64]) {
        for (i, sum) in out.iter_mut().enumerate() {
            *sum = 0.0;
            for block in self.blocks(i) {
                let first = self.particle[block] as usize * D;
                for k in 0..D {
                    *sum += b[block * D + k] * u[first + k];
                }
            }
        }
    }

    /// out += Bᵀ x.
    pub(super) fn add_transposed<const D: usize>(&self, b: &[f64], x: &[f64], out: &mut [f64]) {
        for (i, &x) in x.iter().enumerate() {
            for block in self.blocks(i) {
                let first = self.particle[block] as usize * D;
                for k in 0..D {
                    out[first + k] += b[block * D + k] * x;
                }
            }
        }
    }
}

/// The square at which conjugate gradients end: twelve digits of what they began with, or roundoff of x.
pub(super) fn least(first: f64, x: &[f64]) -> f64 {
    (1e-24 * first).max(64.0 * f64::EPSILON * f64::EPSILON * dot(x, x))
}

/// x += factor y.
pub(super) fn add(factor: f64, y: &[f64], x: &mut [f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x += factor * y;
    }
}

pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// max |x_i|.
pub(super) fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}
