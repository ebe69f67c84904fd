//! The factor of A + ε I, and λ from it.
//!
//! ```text
//! M = S (A + ε I) S,   S = diag(A + ε I)^(−½)        rows scaled to a unit diagonal
//! M x = S b,   λ = S x
//! ```
//!
//! Rows that are left out have S = 0 and λ = 0: inactive rows, rows without a gradient, and rows that follow from
//! others (`independent.rs`). Over the other rows M is positive definite, and L D Lᵀ exists. Its pivots may still be as
//! small as the ratio of two masses; a pivot that roundoff has taken is replaced, and the solution is refined.

use super::memory::FactorMemory;
use crate::linalg::{Factor, SmallPivots};
use crate::structure::MatrixStructure;

/// Pivot of M up to which roundoff may have taken it, a few hundred roundings of the unit diagonal, and the pivot in
/// its place. Refinement shrinks the error by this number over the true pivot each pass, and roundoff is amplified by
/// its inverse.
const TAKEN: [f64; 2] = [1e-13, 1e-8];

/// The same in a matrix with hubs. Before a hub is eliminated, its share is missing in a pivot, which may then be
/// anything, while the matrix is regular. So there is more to gain by refinement.
const WITHOUT_HUB: [f64; 2] = [1e-10, 1e-6];

/// Pivot in a matrix with hubs below which every solution is refined.
const SMALL_WITHOUT_HUB: f64 = 1e-3;

/// δ of a least-squares solution, far below the eigenvalues of rows that agree.
const SHIFT: f64 = 1e-8;

/// Relative residual above which a solution is refined. Under a load of a billion beads x is a billion times b, and the
/// rounding of x alone gives a residual of 1e-7.
const ACCEPTED_RESIDUAL: f64 = 1e-6;

/// Relative residual at which refinement stops: a few times roundoff.
const REFINED: f64 = 1e-14;

/// Passes of refinement: it takes two to five where no pivot was replaced by one much larger.
const PASSES: usize = 30;

/// (A + ε I), scaled and factored. Inside, rows are in the order of elimination.
#[derive(Clone, Debug)]
pub(crate) struct MultiplierSolver {
    factor: Factor,
    /// S, zero for rows that are left out.
    scale: Vec<f64>,
    /// M, in the slots of A.
    scaled: Vec<f64>,
    /// Rows left out because they follow from others, ascending.
    dependent: Vec<u32>,
    /// The smallest pivot of the factor at hand.
    smallest: f64,
    /// Whether pivots were replaced, so that every solution is refined.
    is_perturbed: bool,
    /// Whether a solution with a large residual is refined.
    is_refined: bool,
    /// The state of the A that is factored.
    pub(crate) memory: FactorMemory,
    pub(crate) factorizations: usize,
    /// The residual of the last solution, relative to its right-hand side.
    imbalance: f64,
    /// max |x| over max |S b| of the last solution.
    growth: f64,
    /// x, r = b − M x, and S b.
    x: Vec<f64>,
    r: Vec<f64>,
    b: Vec<f64>,
}

impl MultiplierSolver {
    pub(crate) fn new(matrix: &MatrixStructure) -> Self {
        let m = matrix.pattern.order();
        MultiplierSolver {
            factor: Factor::with(&matrix.symbolic),
            scale: vec![0.0; m],
            scaled: vec![0.0; matrix.pattern.len()],
            dependent: Vec::new(),
            smallest: f64::INFINITY,
            is_perturbed: false,
            is_refined: true,
            memory: FactorMemory::default(),
            factorizations: 0,
            imbalance: 0.0,
            growth: 0.0,
            x: vec![0.0; m],
            r: vec![0.0; m],
            b: vec![0.0; m],
        }
    }

    /// Factors A + ε I without the rows that are inactive or dependent, or that have no gradient (a zero on the
    /// diagonal). `inactive` may be empty: every row is active. Returns the smallest pivot; one that is not positive
    /// means that there is no factor.
    pub(crate) fn factor(
        &mut self,
        matrix: &MatrixStructure,
        A: &[f64],
        epsilon: f64,
        inactive: &[bool],
        dependent: &[u32],
    ) -> f64 {
        self.scale_rows(matrix, A, epsilon, inactive, dependent);
        (self.is_perturbed, self.is_refined) = (false, true);
        self.factorizations += 1;
        self.smallest = self.factor.factor(&matrix.pattern, &self.scaled, 0.0);
        self.smallest
    }

    /// The same with a number in place of every pivot that roundoff has taken: there is a factor in any case.
    pub(crate) fn factor_perturbed(
        &mut self,
        matrix: &MatrixStructure,
        A: &[f64],
        epsilon: f64,
        inactive: &[bool],
        dependent: &[u32],
    ) {
        self.scale_rows(matrix, A, epsilon, inactive, dependent);
        self.factorizations += 1;
        let mut met = Vec::new();
        let [below, instead] = if matrix.on_hubs.is_empty() { TAKEN } else { WITHOUT_HUB };
        let mut small = SmallPivots { shift: 0.0, below, instead: Some(instead), met: &mut met };
        self.smallest = self.factor.factor_with(&matrix.pattern, &self.scaled, &mut small);
        let is_poor = !matrix.on_hubs.is_empty() && self.smallest < SMALL_WITHOUT_HUB;
        (self.is_perturbed, self.is_refined) = (!met.is_empty() || is_poor, true);
    }

    /// Factors M + δ I over all active rows but some.
    pub(super) fn factor_shifted(&mut self, matrix: &MatrixStructure, A: &[f64], inactive: &[bool], dependent: &[u32]) {
        self.scale_rows(matrix, A, 0.0, inactive, dependent);
        self.factorizations += 1;
        let [below, instead] = TAKEN;
        let mut small = SmallPivots { shift: SHIFT, below, instead: Some(instead), met: &mut Vec::new() };
        self.smallest = self.factor.factor_with(&matrix.pattern, &self.scaled, &mut small);
        // A solution of a shifted matrix does not satisfy the equation, and is not to be refined.
        self.is_refined = false;
    }

    /// The residual of the last solution, relative to its right-hand side.
    pub(crate) fn imbalance(&self) -> f64 {
        self.imbalance
    }

    /// The smallest pivot of the factor at hand.
    pub(crate) fn smallest_pivot(&self) -> f64 {
        self.smallest
    }

    /// The rows left out of the factor at hand because they follow from others, ascending.
    pub(crate) fn dependent(&self) -> &[u32] {
        &self.dependent
    }

    /// S and M for A + ε I; keeps which rows are left out.
    pub(super) fn scale_rows(
        &mut self,
        matrix: &MatrixStructure,
        A: &[f64],
        epsilon: f64,
        inactive: &[bool],
        dependent: &[u32],
    ) {
        let pattern = &matrix.pattern;
        self.memory.forget();
        self.dependent.clear();
        self.dependent.extend_from_slice(dependent);
        // r = diag(A + ε I), to which hubs add their part.
        for i in 0..self.r.len() {
            self.r[i] = A[pattern.diagonal(i)] + epsilon;
        }
        for on_hub in &matrix.on_hubs {
            self.r[on_hub.row as usize] += A[on_hub.slot as usize] * A[on_hub.slot as usize];
        }
        // S.
        for (i, &row) in matrix.order.iter().enumerate() {
            if matrix.is_hub(row) {
                self.scale[i] = 1.0;
                continue;
            }
            let diagonal = self.r[i];
            let inactive = inactive.get(row as usize).is_some_and(|inactive| *inactive);
            let is_kept = !matrix.inert[row as usize] && !inactive && diagonal > 0.0;
            let is_dependent = !dependent.is_empty() && dependent.binary_search(&row).is_ok();
            self.scale[i] = if is_kept && !is_dependent { 1.0 / diagonal.sqrt() } else { 0.0 };
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
    }

    /// L D Lᵀ of the M at hand without the rows whose pivots are up to `below`; returns their places in the order of
    /// elimination, and their pivots.
    pub(super) fn factor_waiting(&mut self, matrix: &MatrixStructure, below: f64) -> Vec<(usize, f64)> {
        let mut met = Vec::new();
        let mut small = SmallPivots { shift: 0.0, below, instead: Some(f64::INFINITY), met: &mut met };
        self.factorizations += 1;
        self.factor.factor_with(&matrix.pattern, &self.scaled, &mut small);
        met
    }

    /// λ ← S x with M x = S b, zero in the rows that wait and in those left out.
    pub(super) fn solve_waiting(&mut self, matrix: &MatrixStructure, b: &[f64], lambda: &mut [f64]) {
        self.scale_into(matrix, b);
        self.x.copy_from_slice(&self.b);
        self.factor.solve(&mut self.x);
        self.scale_out(matrix, lambda);
    }

    /// λ ← (A + ε I)⁻¹ b, zero in the rows that are left out.
    pub(crate) fn solve(&mut self, matrix: &MatrixStructure, b: &[f64], lambda: &mut [f64]) {
        self.scale_into(matrix, b);
        self.x.copy_from_slice(&self.b);
        self.factor.solve(&mut self.x);
        self.residual(matrix);
        let size = largest(&self.b);
        // A right-hand side that is not finite does not come from the matrix; the step will report it.
        let is_off = self.is_perturbed || largest(&self.r) > ACCEPTED_RESIDUAL * size;
        if self.is_refined && size.is_finite() && is_off {
            self.refine(matrix, size);
        }
        (self.growth, self.imbalance) =
            if size > 0.0 { (largest(&self.x) / size, largest(&self.r) / size) } else { (0.0, 0.0) };
        self.scale_out(matrix, lambda);
    }

    /// max |x| of the last solution.
    pub(crate) fn largest_x(&self) -> f64 {
        largest(&self.x)
    }

    /// The growth from the right-hand side to the last solution, rows scaled.
    pub(crate) fn growth(&self) -> f64 {
        self.growth
    }

    /// x ← x + M⁻¹ (b − M x), as long as the residual halves.
    fn refine(&mut self, matrix: &MatrixStructure, size: f64) {
        let mut reached = largest(&self.r);
        for _ in 0..PASSES {
            if reached.is_nan() || reached <= REFINED * size {
                break;
            }
            self.factor.solve(&mut self.r);
            for i in 0..self.x.len() {
                self.x[i] += self.r[i];
            }
            self.residual(matrix);
            let last = std::mem::replace(&mut reached, largest(&self.r));
            if reached > 0.5 * last {
                break;
            }
        }
    }

    /// r ← b − M x.
    fn residual(&mut self, matrix: &MatrixStructure) {
        matrix.pattern.multiply(&self.scaled, &self.x, &mut self.r);
        for i in 0..self.r.len() {
            self.r[i] = self.b[i] - self.r[i];
        }
    }

    /// S b, in the order of elimination.
    fn scale_into(&mut self, matrix: &MatrixStructure, b: &[f64]) {
        for (i, &row) in matrix.order.iter().enumerate() {
            self.b[i] = if matrix.is_hub(row) { 0.0 } else { self.scale[i] * b[row as usize] };
        }
    }

    /// λ ← S x.
    fn scale_out(&self, matrix: &MatrixStructure, lambda: &mut [f64]) {
        for (i, &row) in matrix.order.iter().enumerate() {
            if !matrix.is_hub(row) {
                lambda[row as usize] = self.scale[i] * self.x[i];
            }
        }
    }

    /// The rows that were left out of the last factorization for any reason, ascending.
    pub(crate) fn left_out(&self, matrix: &MatrixStructure) -> Vec<usize> {
        let all = matrix.order.iter().zip(&self.scale);
        let mut rows: Vec<usize> = all.filter(|&(_, &scale)| scale == 0.0).map(|(&row, _)| row as usize).collect();
        rows.sort_unstable();
        rows
    }

    /// Rank of A at the last factorization.
    pub(crate) fn rank(&self, matrix: &MatrixStructure) -> usize {
        matrix.inert.len() - self.left_out(matrix).len()
    }
}

/// max |x_i|; not a number if any is not.
fn largest(x: &[f64]) -> f64 {
    let mut largest = 0.0_f64;
    for &value in x {
        if value.is_nan() {
            return value;
        }
        largest = largest.max(value.abs());
    }
    largest
}
