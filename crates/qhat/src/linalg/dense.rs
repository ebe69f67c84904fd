//! Dense LDLᵀ without pivoting, for small positive definite matrices.
//!
//! ```text
//! A = L D Lᵀ,  L unit lower triangular, D diagonal:
//! D_j  = A_jj − Σ_{k<j} L_jk² D_k,   L_ij = (A_ij − Σ_{k<j} L_ik L_jk D_k)/D_j
//! ```

use super::Pattern;
use super::small_pivots::SmallPivots;

/// L below the diagonal and D on it, row after row.
#[derive(Clone, Debug)]
pub(crate) struct DenseLdl {
    order: usize,
    factor: Vec<f64>,
}

impl DenseLdl {
    pub(crate) fn new(order: usize) -> Self {
        DenseLdl { order, factor: vec![0.0; order * order] }
    }

    pub(crate) fn factor(&mut self, pattern: &Pattern, values: &[f64], small: &mut SmallPivots<'_>) -> f64 {
        let n = self.order;
        self.factor.fill(0.0);
        for i in 0..n {
            for slot in pattern.start[i]..pattern.start[i + 1] {
                self.factor[i * n + pattern.column[slot]] = values[slot];
            }
            self.factor[i * n + i] += small.shift;
        }
        let mut smallest = f64::INFINITY;
        for i in 0..n {
            let (above, row) = self.factor.split_at_mut(i * n);
            // First y_j = L_ij D_j by forward substitution, then L_ij = y_j / D_j and D_i.
            for j in 0..i {
                let l = &above[j * n..][..j];
                let mut y = row[j];
                for k in 0..j {
                    y -= l[k] * row[k];
                }
                row[j] = y;
            }
            let mut pivot = row[i];
            for j in 0..i {
                let y = row[j];
                row[j] = y / above[j * n + j];
                pivot -= row[j] * y;
            }
            row[i] = pivot;
            if pivot.is_nan() || pivot <= small.below {
                match small.pivot_instead(i, pivot) {
                    Some(instead) => row[i] = instead,
                    None => return pivot,
                }
            } else {
                smallest = smallest.min(pivot);
            }
        }
        smallest
    }

    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = self.order;
        for i in 0..n {
            for j in 0..i {
                x[i] -= self.factor[i * n + j] * x[j];
            }
        }
        for i in 0..n {
            x[i] /= self.factor[i * n + i];
        }
        for i in (0..n).rev() {
            for j in 0..i {
                x[j] -= self.factor[i * n + j] * x[i];
            }
        }
    }
}
