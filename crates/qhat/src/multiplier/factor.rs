//! Solving (A + ε I) λ = b, whatever the rank of A.
//!
//! Rows are scaled to a unit diagonal first, M = S (A + ε I) S with S = diag(A + ε I)^(−½), so that rows of different units
//! and very different masses are judged alike. A plain LDLᵀ of M is tried; where a pivot comes out tiny, or the solution
//! does not satisfy the equation, M is singular to working precision (redundant rows) and G = (M + δ I)⁻¹ takes over:
//!
//! ```text
//! null(y) = lim Pᵏ y,  P = δ G       P keeps the null space of M and shrinks its range by δ/(σ + δ)
//! x ← x + G (b − null(b) − M x)      refinement, from 0: stays in the range of M, so it goes to the least norm x
//! x ← x − null(x)                    removes the roundoff that G has amplified by 1/δ in the null space
//! ```
//!
//! λ = S x is then the least-norm solution in the scaled rows; the constraint force Jᵀλ is unique in any case. |null(b)| tells
//! how far the rows contradict each other. A step that only wants the force leaves both null(·) out.

use crate::linalg::{Factor, rank};
use crate::structure::MatrixStructure;

/// A pivot of the scaled matrix below this is taken for zero. Pivots of regular systems are about the smallest ratio of
/// inverse masses (1e-9 for a load of a billion beads); roundoff leaves some 1e-15 of a zero.
const TINY_PIVOT: f64 = 1e-12;

/// δ. Refinement shrinks the error by δ/σ a pass, so δ must lie well below the eigenvalues σ that matter; roundoff is
/// amplified by 1/δ, so it must lie well above 1e-16.
const REGULARIZATION: f64 = 1e-8;

/// δ where only the force is wanted: what it amplifies in the null space then does no harm, and a long truss, whose smallest
/// eigenvalue lies below 1e-8, needs a few passes instead of all.
const SLIGHT: f64 = 1e-12;

/// A solution that misses its right side by more than this, relative, was not solved by the plain factor. Under a load of a
/// billion beads x is a billion times b, and the rounding of x alone misses b by 1e-7; G would let such a load fall.
const ACCEPTED_RESIDUAL: f64 = 1e-6;

/// Where refinement has arrived, by what is wanted: a few times roundoff; what leaves q̈ ten digits in the worst structures; and
/// what makes the next correction a thousand times smaller.
const fn refined(wanted: SolveFor) -> f64 {
    match wanted {
        SolveFor::LeastNorm => 1e-14,
        SolveFor::Force => 1e-12,
        SolveFor::Correction => 1e-3,
    }
}

/// Refinement and null(·) converge in two to five passes where they converge; they must not go on for ever elsewhere.
const PASSES: usize = 10;

/// Above this order the rank is not computed (the work grows with its cube), only that it is deficient is said.
const RANK_UP_TO: usize = 1200;

/// A residual of the refinement above this, relative, means that the rows contradict each other by more than roundoff. Without
/// null(b) taken out, x has then grown by 1/δ times as much along the null space, and Jᵀ would have to cancel it.
const CONTRADICTION: f64 = 1e-8;

/// Which of the λ that do the same a solution is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SolveFor {
    /// The least, for people to look at.
    LeastNorm,
    /// Any that makes the force.
    Force,
    /// Any that nearly makes it: a correction that is looked at afterwards, and made again if need be.
    Correction,
}

/// (A + ε I), scaled and factored. Inside, rows are in the order of elimination.
#[derive(Clone, Debug)]
pub(crate) struct MultiplierSolver {
    factor: Factor,
    scale: Vec<f64>,
    /// M, in the slots of A.
    scaled: Vec<f64>,
    /// Whether G is in use.
    pub(crate) deficient: bool,
    /// δ.
    delta: f64,
    /// Whether to take G at once the next time: until someone asks anew, what was singular is taken to stay so.
    pub(crate) stays_deficient: bool,
    /// Whether M has a null space. Where there are hubs, G may be needed although it has none.
    pub(crate) singular: bool,
    dropped: usize,
    /// Relative part of the last right side that no λ can meet.
    pub(crate) contradiction: f64,
    pub(crate) factorizations: usize,
    x: Vec<f64>,
    r: Vec<f64>,
    y: Vec<f64>,
    b: Vec<f64>,
}

impl MultiplierSolver {
    pub(crate) fn new(matrix: &MatrixStructure) -> Self {
        let m = matrix.pattern.order();
        MultiplierSolver {
            factor: Factor::with(&matrix.symbolic),
            scale: vec![0.0; m],
            scaled: vec![0.0; matrix.pattern.len()],
            deficient: false,
            delta: REGULARIZATION,
            stays_deficient: false,
            singular: false,
            dropped: 0,
            contradiction: 0.0,
            factorizations: 0,
            x: vec![0.0; m],
            r: vec![0.0; m],
            y: vec![0.0; m],
            b: vec![0.0; m],
        }
    }

    /// Factors A + ε I. Rows without any gradient (a zero on the diagonal) and those that are off are left out: their λ is
    /// zero. `inactive` may be empty.
    pub(crate) fn factor(&mut self, matrix: &MatrixStructure, A: &[f64], epsilon: f64, inactive: &[bool]) {
        let pattern = &matrix.pattern;
        // diag(A + ε I), to which hubs add their part.
        for i in 0..self.r.len() {
            self.r[i] = A[pattern.diagonal(i)] + epsilon;
        }
        for on_hub in &matrix.on_hubs {
            self.r[on_hub.row as usize] += A[on_hub.slot as usize] * A[on_hub.slot as usize];
        }
        self.dropped = 0;
        for (i, &row) in matrix.order.iter().enumerate() {
            if matrix.is_hub(row) {
                self.scale[i] = 1.0;
                continue;
            }
            let diagonal = self.r[i];
            let inactive = inactive.get(row as usize).is_some_and(|inactive| *inactive);
            let takes_part = !matrix.inert[row as usize] && !inactive && diagonal > 0.0;
            self.scale[i] = if takes_part { 1.0 / diagonal.sqrt() } else { 0.0 };
            self.dropped += usize::from(!takes_part);
        }
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
        self.deficient = false;
        if self.stays_deficient {
            return self.add_delta(matrix, SLIGHT);
        }
        self.singular = false;
        self.factorizations += 1;
        let smallest = self.factor.factor(pattern, &self.scaled, 0.0);
        if smallest.is_nan() || smallest < TINY_PIVOT {
            self.regularize(matrix);
        }
    }

    /// Goes over to G, unless it is in use.
    pub(crate) fn regularize(&mut self, matrix: &MatrixStructure) {
        if !self.deficient {
            // Whether there is a null space is asked of the larger δ; without hubs there must be one.
            let has_hubs = !matrix.on_hubs.is_empty();
            self.add_delta(matrix, if has_hubs { REGULARIZATION } else { SLIGHT });
            self.singular = !has_hubs || self.has_null_space(matrix);
            self.stays_deficient = true;
        }
    }

    /// G for one δ.
    fn add_delta(&mut self, matrix: &MatrixStructure, delta: f64) {
        (self.deficient, self.delta) = (true, delta);
        self.factorizations += 1;
        self.factor.factor(&matrix.pattern, &self.scaled, delta);
    }

    /// λ ← (A + ε I)⁻¹ b, or a λ that comes nearest where the matrix is singular.
    pub(crate) fn solve(&mut self, matrix: &MatrixStructure, b: &[f64], wanted: SolveFor, lambda: &mut [f64]) {
        for (i, &row) in matrix.order.iter().enumerate() {
            self.b[i] = if matrix.is_hub(row) { 0.0 } else { self.scale[i] * b[row as usize] };
        }
        self.contradiction = 0.0;
        if !self.deficient && !self.solve_plain(matrix) {
            self.regularize(matrix);
        }
        if self.deficient {
            let is_met = wanted != SolveFor::LeastNorm && self.refine(matrix, wanted);
            if !is_met && wanted != SolveFor::Correction {
                self.solve_least(matrix);
            }
        }
        for (i, &row) in matrix.order.iter().enumerate() {
            if !matrix.is_hub(row) {
                lambda[row as usize] = self.scale[i] * self.x[i];
            }
        }
    }

    /// Whether the plain factor solved it.
    fn solve_plain(&mut self, matrix: &MatrixStructure) -> bool {
        self.x.copy_from_slice(&self.b);
        self.factor.solve(&mut self.x);
        self.residual(matrix);
        let (residual, size) = (largest(&self.r), largest(&self.b));
        // A right side that is not finite is not the matrix's fault; the step will report it.
        residual <= ACCEPTED_RESIDUAL * size || !size.is_finite()
    }

    fn solve_least(&mut self, matrix: &MatrixStructure) {
        if self.delta != REGULARIZATION {
            self.add_delta(matrix, REGULARIZATION);
        }
        let size = largest(&self.b);
        self.y.copy_from_slice(&self.b);
        self.keep_null_space(matrix, size);
        for i in 0..self.b.len() {
            self.b[i] -= self.y[i];
        }
        self.contradiction = if size > 0.0 { largest(&self.y) / size } else { 0.0 };
        self.refine(matrix, SolveFor::LeastNorm);
        self.y.copy_from_slice(&self.x);
        self.clear_hubs(matrix);
        self.keep_null_space(matrix, largest(&self.y));
        for i in 0..self.x.len() {
            self.x[i] -= self.y[i];
        }
    }

    /// x ← x + G (b − M x) from 0; whether b was met but for roundoff.
    fn refine(&mut self, matrix: &MatrixStructure, wanted: SolveFor) -> bool {
        let size = largest(&self.b);
        self.x.fill(0.0);
        self.r.copy_from_slice(&self.b);
        let mut reached = size;
        for _ in 0..PASSES {
            if reached.is_nan() || reached <= refined(wanted) * size {
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
        reached <= CONTRADICTION * size
    }

    /// y ← null(y): P until nothing more goes; what goes is measured against `size`, the largest |y| at the start.
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

    /// Whether null(·) leaves anything of a vector that is like no other. The part of M that a hub's unknowns couple may be
    /// singular where M is not: three rods in one plane hold a particle up to the motion of their other ends.
    fn has_null_space(&mut self, matrix: &MatrixStructure) -> bool {
        for (i, y) in self.y.iter_mut().enumerate() {
            *y = (i as f64 * 0.618_033_988_749_895).fract() - 0.5;
        }
        self.clear_hubs(matrix);
        self.keep_null_space(matrix, 1.0);
        // Of a direction with σ > 1e-6 ten passes leave 1e-20; of the null space they leave what there was.
        largest(&self.y) > 1e-9
    }

    /// y ← 0 where a hub's unknowns are: they are no part of the rows' space.
    fn clear_hubs(&mut self, matrix: &MatrixStructure) {
        if !matrix.on_hubs.is_empty() {
            for (y, &row) in self.y.iter_mut().zip(&matrix.order) {
                *y = if matrix.is_hub(row) { 0.0 } else { *y };
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

    /// The rows that took no part in the last factorization, ascending.
    pub(crate) fn left_out(&self, matrix: &MatrixStructure) -> Vec<usize> {
        let all = matrix.order.iter().zip(&self.scale);
        let mut rows: Vec<usize> = all.filter(|&(_, &scale)| scale == 0.0).map(|(&row, _)| row as usize).collect();
        rows.sort_unstable();
        rows
    }

    /// Rank of A at the last factorization; `None` where computing it would take too long.
    pub(crate) fn rank(&self, matrix: &MatrixStructure) -> Option<usize> {
        let pattern = &matrix.pattern;
        let m = matrix.inert.len();
        if !self.singular {
            return Some(m - self.dropped);
        }
        if m > RANK_UP_TO {
            return None;
        }
        let n = pattern.order();
        let mut dense = vec![0.0; n * n];
        for i in 0..n {
            for slot in pattern.start[i]..pattern.start[i + 1] {
                let j = pattern.column[slot];
                dense[i * n + j] = self.scaled[slot];
                dense[j * n + i] = self.scaled[slot];
            }
        }
        // Hubs are eliminated: what they couple is added up.
        for h in (0..n).filter(|&h| matrix.is_hub(matrix.order[h])) {
            let column: Vec<f64> = (0..n).map(|i| dense[i * n + h]).collect();
            for i in (0..n).filter(|&i| i != h && column[i] != 0.0) {
                for j in 0..n {
                    dense[i * n + j] += column[i] * column[j];
                }
            }
            dense[h * n..(h + 1) * n].fill(0.0);
            (0..n).for_each(|i| dense[i * n + h] = 0.0);
        }
        for i in (0..n).filter(|&i| !matrix.is_hub(matrix.order[i])) {
            dense[i * n + i] = if self.scale[i] > 0.0 { 1.0 } else { 0.0 };
        }
        Some(rank(n, dense))
    }
}

/// max |x_i|; NaN if any is.
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
