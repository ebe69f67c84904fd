//! The factor of A + ε I, and λ from it.
//!
//! ```text
//! M = S (A + ε I) S,   S = diag(A + ε I)^(−½)        rows scaled to a unit diagonal
//! M x = S b,   λ = S x
//! ```
//!
//! Scaling judges rows of different units and masses of 1e9:1 by one threshold. A plain LDLᵀ of M is tried first.
//! Where a pivot is tiny, or the solution does not satisfy the equation, M is singular to working precision
//! (redundant rows), and the regularised factor of `singular.rs` takes over.

use super::memory::FactorMemory;
use crate::linalg::{Factor, rank_of};
use crate::structure::MatrixStructure;

/// Pivot of the scaled matrix below which M counts as singular. Pivots of regular systems are about the smallest
/// ratio of inverse masses (1e-9 for a load of a billion beads); roundoff leaves some 1e-15 of a zero.
const TINY_PIVOT: f64 = 1e-12;

/// Relative residual above which a solution of the plain factor is refused. Under a load of a billion beads x is a
/// billion times b, and the rounding of x alone gives a residual of 1e-7; G would let such a load fall.
const ACCEPTED_RESIDUAL: f64 = 1e-6;

/// Order above which the rank is not computed, since the work grows with its cube; only the deficiency is reported.
const RANK_UP_TO: usize = 1200;

/// The solution of a singular A λ = b that is wanted, and its accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SolveFor {
    /// The λ of least norm: for terms and tensions that people read.
    LeastNorm,
    /// Any λ that gives the constraint force to roundoff: for q̈ and velocities.
    Force,
    /// Any λ that nearly gives it: for a Newton correction, whose residual is evaluated afterwards.
    Correction,
}

/// (A + ε I), scaled and factored. Inside, rows are in the order of elimination.
#[derive(Clone, Debug)]
pub(crate) struct MultiplierSolver {
    pub(super) factor: Factor,
    /// S, zero for rows that are left out.
    scale: Vec<f64>,
    /// M, in the slots of A.
    pub(super) scaled: Vec<f64>,
    /// Whether G is in use.
    pub(crate) deficient: bool,
    /// δ of G (`singular.rs`).
    pub(super) delta: f64,
    /// The state of the A that is factored, and whether A was singular.
    pub(crate) memory: FactorMemory,
    /// Whether M has a null space. With hubs, G may be needed although M has none.
    pub(crate) singular: bool,
    /// Number of rows left out of the last factorization.
    dropped: usize,
    pub(crate) factorizations: usize,
    /// x, r = b − M x, y of null(y), and S b.
    pub(super) x: Vec<f64>,
    pub(super) r: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) b: Vec<f64>,
}

impl MultiplierSolver {
    pub(crate) fn new(matrix: &MatrixStructure) -> Self {
        let m = matrix.pattern.order();
        MultiplierSolver {
            factor: Factor::with(&matrix.symbolic),
            scale: vec![0.0; m],
            scaled: vec![0.0; matrix.pattern.len()],
            deficient: false,
            delta: 0.0,
            memory: FactorMemory::default(),
            singular: false,
            dropped: 0,
            factorizations: 0,
            x: vec![0.0; m],
            r: vec![0.0; m],
            y: vec![0.0; m],
            b: vec![0.0; m],
        }
    }

    /// Factors A + ε I. Inactive rows and rows without a gradient (a zero on the diagonal) are left out: their λ is
    /// zero. `inactive` may be empty: every row is active.
    pub(crate) fn factor(&mut self, matrix: &MatrixStructure, A: &[f64], epsilon: f64, inactive: &[bool]) {
        let pattern = &matrix.pattern;
        self.memory.forget();
        // r = diag(A + ε I), to which hubs add their part.
        for i in 0..self.r.len() {
            self.r[i] = A[pattern.diagonal(i)] + epsilon;
        }
        for on_hub in &matrix.on_hubs {
            self.r[on_hub.row as usize] += A[on_hub.slot as usize] * A[on_hub.slot as usize];
        }
        // S.
        self.dropped = 0;
        for (i, &row) in matrix.order.iter().enumerate() {
            if matrix.is_hub(row) {
                self.scale[i] = 1.0;
                continue;
            }
            let diagonal = self.r[i];
            let inactive = inactive.get(row as usize).is_some_and(|inactive| *inactive);
            let is_kept = !matrix.inert[row as usize] && !inactive && diagonal > 0.0;
            self.scale[i] = if is_kept { 1.0 / diagonal.sqrt() } else { 0.0 };
            self.dropped += usize::from(!is_kept);
        }
        // M.
        for i in 0..self.scale.len() {
            let diagonal = pattern.diagonal(i);
            for slot in pattern.start[i]..diagonal {
                self.scaled[slot] = self.scale[i] * A[slot] * self.scale[pattern.column[slot]];
            }
            self.scaled[diagonal] = 1.0;
        }
        if !matrix.on_hubs.is_empty() {
            for i in 0..self.scale.len() {
                let diagonal = pattern.diagonal(i);
                if matrix.is_hub(matrix.order[i]) {
                    self.scaled[diagonal] = A[diagonal];
                } else if self.scale[i] > 0.0 && self.r[i] != A[diagonal] + epsilon {
                    self.scaled[diagonal] = (A[diagonal] + epsilon) / self.r[i];
                }
            }
        }
        // L D Lᵀ = M, or M + δ I.
        self.deficient = false;
        if self.memory.stays_deficient {
            return self.factor_as_before(matrix);
        }
        self.singular = false;
        self.factorizations += 1;
        let smallest = self.factor.factor(pattern, &self.scaled, 0.0);
        if smallest.is_nan() || smallest < TINY_PIVOT {
            self.regularize(matrix);
        }
    }

    /// λ ← (A + ε I)⁻¹ b; where the matrix is singular, a λ that comes nearest, as `wanted` says.
    pub(crate) fn solve(&mut self, matrix: &MatrixStructure, b: &[f64], wanted: SolveFor, lambda: &mut [f64]) {
        for (i, &row) in matrix.order.iter().enumerate() {
            self.b[i] = if matrix.is_hub(row) { 0.0 } else { self.scale[i] * b[row as usize] };
        }
        if !self.deficient && !self.solve_plain(matrix) {
            self.regularize(matrix);
        }
        if self.deficient {
            self.solve_singular(matrix, wanted);
        }
        for (i, &row) in matrix.order.iter().enumerate() {
            if !matrix.is_hub(row) {
                lambda[row as usize] = self.scale[i] * self.x[i];
            }
        }
    }

    /// x by the plain factor; whether it satisfies the equation.
    fn solve_plain(&mut self, matrix: &MatrixStructure) -> bool {
        self.x.copy_from_slice(&self.b);
        self.factor.solve(&mut self.x);
        self.residual(matrix);
        let (residual, size) = (largest_or_nan(&self.r), largest_or_nan(&self.b));
        // A right-hand side that is not finite does not come from the matrix; the step will report it.
        residual <= ACCEPTED_RESIDUAL * size || !size.is_finite()
    }

    /// r ← b − M x.
    pub(super) fn residual(&mut self, matrix: &MatrixStructure) {
        matrix.pattern.multiply(&self.scaled, &self.x, &mut self.r);
        for i in 0..self.r.len() {
            self.r[i] = self.b[i] - self.r[i];
        }
    }

    /// The rows that were left out of the last factorization, ascending.
    pub(crate) fn left_out(&self, matrix: &MatrixStructure) -> Vec<usize> {
        let all = matrix.order.iter().zip(&self.scale);
        let mut rows: Vec<usize> = all.filter(|&(_, &scale)| scale == 0.0).map(|(&row, _)| row as usize).collect();
        rows.sort_unstable();
        rows
    }

    /// Rank of A at the last factorization; `None` where computing it would take too long.
    pub(crate) fn rank(&self, matrix: &MatrixStructure) -> Option<usize> {
        let m = matrix.inert.len();
        if !self.singular {
            return Some(m - self.dropped);
        }
        if m > RANK_UP_TO {
            return None;
        }
        let is_hub = |i: usize| matrix.is_hub(matrix.order[i]);
        Some(rank_of(&matrix.pattern, &self.scaled, is_hub, |i| self.scale[i] > 0.0))
    }
}

/// max |x_i|; not a number if any is not.
pub(super) fn largest_or_nan(x: &[f64]) -> f64 {
    let mut largest = 0.0_f64;
    for &value in x {
        if value.is_nan() {
            return value;
        }
        largest = largest.max(value.abs());
    }
    largest
}
