//! λ where M = S (A + ε I) S is singular: rows that repeat each other.
//!
//! The regularised factor G = (M + δ I)⁻¹ exists for every M. With it
//!
//! ```text
//! null(y) = lim Pᵏ y,  P = δ G       P keeps the null space of M and shrinks its range by δ/(σ + δ)
//! x ← x + G (b − null(b) − M x)      refinement, from 0: stays in the range of M, so it goes to the least norm x
//! x ← x − null(x)                    removes the roundoff that G has amplified by 1/δ in the null space
//! ```
//!
//! σ: an eigenvalue of M. λ = S x is then the least-norm solution in the scaled rows; the constraint force Jᵀλ is
//! unique in any case. |null(b)| is how far the rows contradict each other. A solve for the force alone leaves out
//! both null(·), and takes a smaller δ.

use super::factor::{MultiplierSolver, SolveFor, largest_or_nan};
use crate::structure::MatrixStructure;

/// δ of a least-norm solve. Refinement shrinks the error by δ/σ a pass, so δ must lie well below the eigenvalues σ that
/// matter; roundoff is amplified by 1/δ, so δ must lie well above 1e-16.
const REGULARIZATION: f64 = 1e-8;

/// δ of a solve for the force alone. What it amplifies in the null space does no harm there, and a long truss, whose
/// smallest eigenvalue lies below 1e-8, needs a few passes instead of all.
const SLIGHT: f64 = 1e-12;

/// Refinement and null(·) take two to five passes where they converge; the limit ends them where they do not.
const PASSES: usize = 10;

/// Residual of the refinement, relative, above which the rows contradict each other by more than roundoff. With null(b)
/// left in, x has then grown by 1/δ times as much along the null space, and Jᵀ would have to cancel it.
const CONTRADICTION: f64 = 1e-8;

/// Relative residual at which refinement stops: a few times roundoff; ten digits of q̈ in the worst structures; a next
/// Newton correction a thousand times smaller.
const fn refined(wanted: SolveFor) -> f64 {
    match wanted {
        SolveFor::LeastNorm => 1e-14,
        SolveFor::Force => 1e-12,
        SolveFor::Correction => 1e-3,
    }
}

impl MultiplierSolver {
    /// Goes over to G, unless it is in use.
    pub(super) fn regularize(&mut self, matrix: &MatrixStructure) {
        if !self.deficient {
            // The larger δ tells whether there is a null space; without hubs there must be one.
            let has_hubs = !matrix.on_hubs.is_empty();
            self.add_delta(matrix, if has_hubs { REGULARIZATION } else { SLIGHT });
            self.singular = !has_hubs || self.has_null_space(matrix);
            self.memory.stays_deficient = true;
        }
    }

    /// G of an M that is taken to be as singular as the last one.
    pub(super) fn factor_as_before(&mut self, matrix: &MatrixStructure) {
        self.add_delta(matrix, SLIGHT);
    }

    /// The factor of M + δ I.
    fn add_delta(&mut self, matrix: &MatrixStructure, delta: f64) {
        (self.deficient, self.delta) = (true, delta);
        self.factorizations += 1;
        self.factor.factor(&matrix.pattern, &self.scaled, delta);
    }

    /// x from G, as `wanted` says.
    pub(super) fn solve_singular(&mut self, matrix: &MatrixStructure, wanted: SolveFor) {
        let is_met = wanted != SolveFor::LeastNorm && self.refine(matrix, wanted);
        if !is_met && wanted != SolveFor::Correction {
            self.solve_least(matrix);
        }
    }

    /// The x of least norm.
    fn solve_least(&mut self, matrix: &MatrixStructure) {
        if self.delta != REGULARIZATION {
            self.add_delta(matrix, REGULARIZATION);
        }
        // b ← b − null(b).
        let size = largest_or_nan(&self.b);
        self.y.copy_from_slice(&self.b);
        self.keep_null_space(matrix, size);
        for i in 0..self.b.len() {
            self.b[i] -= self.y[i];
        }
        self.refine(matrix, SolveFor::LeastNorm);
        // x ← x − null(x).
        self.y.copy_from_slice(&self.x);
        self.clear_hubs(matrix);
        self.keep_null_space(matrix, largest_or_nan(&self.y));
        for i in 0..self.x.len() {
            self.x[i] -= self.y[i];
        }
    }

    /// x ← x + G (b − M x), from 0; whether b was met to roundoff.
    fn refine(&mut self, matrix: &MatrixStructure, wanted: SolveFor) -> bool {
        let size = largest_or_nan(&self.b);
        self.x.fill(0.0);
        self.r.copy_from_slice(&self.b);
        let mut reached = size;
        for _ in 0..PASSES {
            if reached.is_nan() || reached <= refined(wanted) * size {
                break;
            }
            self.factor.solve(&mut self.r); // G r
            for i in 0..self.x.len() {
                self.x[i] += self.r[i];
            }
            self.residual(matrix); // r = b − M x
            let last = std::mem::replace(&mut reached, largest_or_nan(&self.r));
            if reached > 0.5 * last {
                break;
            }
        }
        reached <= CONTRADICTION * size
    }

    /// y ← null(y): P until y no longer changes, relative to `size`, the largest |y_i| at the start.
    fn keep_null_space(&mut self, matrix: &MatrixStructure, size: f64) {
        for _ in 0..PASSES {
            self.r.copy_from_slice(&self.y);
            self.factor.solve(&mut self.r);
            let mut gone = 0.0_f64;
            for (i, (y, r)) in self.y.iter_mut().zip(&self.r).enumerate() {
                let kept = if matrix.is_hub(matrix.order[i]) { 0.0 } else { REGULARIZATION * r };
                gone = gone.max((*y - kept).abs());
                *y = kept;
            }
            if gone <= f64::EPSILON * size {
                break;
            }
        }
    }

    /// Whether null(·) leaves anything of a generic vector. With hubs, the part of M that a hub's unknowns couple may
    /// be singular where M is not: three rods in one plane hold a particle up to the motion of their other ends.
    fn has_null_space(&mut self, matrix: &MatrixStructure) -> bool {
        for (i, y) in self.y.iter_mut().enumerate() {
            *y = (i as f64 * 0.618_033_988_749_895).fract() - 0.5;
        }
        self.clear_hubs(matrix);
        self.keep_null_space(matrix, 1.0);
        // Ten passes leave 1e-20 of a direction with σ > 1e-6, and all of the null space.
        largest_or_nan(&self.y) > 1e-9
    }

    /// y ← 0 at the unknowns of hubs: they are no part of the space of rows.
    fn clear_hubs(&mut self, matrix: &MatrixStructure) {
        if !matrix.on_hubs.is_empty() {
            for (y, &row) in self.y.iter_mut().zip(&matrix.order) {
                *y = if matrix.is_hub(row) { 0.0 } else { *y };
            }
        }
    }
}
