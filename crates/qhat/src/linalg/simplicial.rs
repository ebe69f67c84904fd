//! Sparse LDLᵀ, row by row ("up-looking"): for matrices whose columns of L have few entries.
//!
//! Row k of L solves L_{<k} D y = A_{k,<k}ᵀ. Only the unknowns below k in the elimination tree contribute, and their
//! list is found once. Source: Davis, Algorithm 849: a concise sparse Cholesky factorization package, ACM TOMS 31
//! (2005).

use super::Lower;
use super::elimination::NONE;
use super::small_pivots::SmallPivots;
use std::ops::Range;

/// The positions of the entries of L. Columns of L are stored one after the other, each with its rows ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct SimplicialPlan {
    /// The rows of the matrix that are factored entry by entry.
    rows: Range<usize>,
    /// The columns of row k of L, ascending, and the position of each entry in column storage.
    row_start: Vec<u32>,
    row_entry: Vec<(u32, u32)>,
    column_start: Vec<u32>,
    row_index: Vec<u32>,
}

impl SimplicialPlan {
    /// The plan for rows that are coupled with no row outside.
    pub(crate) fn new(a: &Lower, rows: Range<usize>) -> Self {
        let (n, first) = (rows.len(), rows.start);
        let (mut parent, mut seen) = (vec![NONE; n], vec![NONE; n]);
        let (mut row_start, mut row_columns) = (vec![0], Vec::new());
        let mut column_start = vec![0; n + 1];
        for k in 0..n {
            seen[k] = k as u32;
            let begin = row_columns.len();
            for &(column, _) in a.row(first + k) {
                let mut i = column as usize - first;
                while seen[i] != k as u32 {
                    if parent[i] == NONE {
                        parent[i] = k as u32;
                    }
                    row_columns.push(i as u32);
                    column_start[i + 1] += 1;
                    seen[i] = k as u32;
                    i = parent[i] as usize;
                }
            }
            // Ascending order is a topological order of the tree.
            row_columns[begin..].sort_unstable();
            row_start.push(row_columns.len() as u32);
        }
        for i in 0..n {
            column_start[i + 1] += column_start[i];
        }
        let mut next = column_start.clone();
        let mut row_index = vec![0; row_columns.len()];
        let mut row_entry = Vec::with_capacity(row_columns.len());
        for k in 0..n {
            for &i in &row_columns[row_start[k] as usize..row_start[k + 1] as usize] {
                let place = &mut next[i as usize];
                row_index[*place as usize] = k as u32;
                row_entry.push((i, *place));
                *place += 1;
            }
        }
        SimplicialPlan { rows, row_start, row_entry, column_start, row_index }
    }

    /// Memory of L [bytes].
    #[cfg(test)]
    pub(crate) fn memory(&self) -> usize {
        20 * self.row_index.len() + 24 * self.rows.len()
    }

    fn column(&self, i: usize) -> Range<usize> {
        self.column_start[i] as usize..self.column_start[i + 1] as usize
    }
}

/// L D Lᵀ of some rows.
#[derive(Clone, Debug)]
pub(crate) struct Simplicial {
    l: Vec<f64>,
    d: Vec<f64>,
    /// One dense row; zero between uses.
    y: Vec<f64>,
}

impl Simplicial {
    pub(crate) fn new(plan: &SimplicialPlan) -> Self {
        let n = plan.rows.len();
        Simplicial { l: vec![0.0; plan.row_index.len()], d: vec![0.0; n], y: vec![0.0; n] }
    }

    pub(crate) fn factor(
        &mut self,
        plan: &SimplicialPlan,
        a: &Lower,
        negative: &[bool],
        values: &[f64],
        small: &mut SmallPivots<'_>,
    ) -> f64 {
        let (n, first) = (plan.rows.len(), plan.rows.start);
        let (l, d, y) = (&mut self.l[..], &mut self.d[..n], &mut self.y[..n]);
        let mut smallest = f64::INFINITY;
        for k in 0..n {
            for &(column, slot) in a.row(first + k) {
                y[column as usize - first] += values[slot as usize];
            }
            let negative = negative[first + k];
            let mut pivot = if negative { y[k] } else { y[k] + small.shift };
            y[k] = 0.0;
            for &(i, place) in &plan.row_entry[plan.row_start[k] as usize..plan.row_start[k + 1] as usize] {
                let (i, place) = (i as usize, place as usize);
                let entry = y[i];
                y[i] = 0.0;
                let begin = plan.column_start[i] as usize;
                for (l, &row) in l[begin..place].iter().zip(&plan.row_index[begin..place]) {
                    y[row as usize] -= l * entry;
                }
                l[place] = entry / d[i];
                pivot -= l[place] * entry;
            }
            d[k] = pivot;
            let pivot = if negative { -pivot } else { pivot };
            if pivot.is_nan() || pivot <= small.below {
                match small.pivot_instead(first + k, pivot) {
                    Some(instead) => d[k] = instead,
                    None => return pivot,
                }
            } else if !negative {
                smallest = smallest.min(pivot);
            }
        }
        smallest
    }

    /// x ← (L D Lᵀ)⁻¹ x for the whole x, of which only these rows change.
    pub(crate) fn solve(&self, plan: &SimplicialPlan, x: &mut [f64]) {
        let x = &mut x[plan.rows.clone()];
        for i in 0..x.len() {
            let known = x[i];
            let column = plan.column(i);
            for (l, &row) in self.l[column.clone()].iter().zip(&plan.row_index[column]) {
                x[row as usize] -= l * known;
            }
        }
        for i in (0..x.len()).rev() {
            let mut sum = x[i] / self.d[i];
            let column = plan.column(i);
            for (l, &row) in self.l[column.clone()].iter().zip(&plan.row_index[column]) {
                sum -= l * x[row as usize];
            }
            x[i] = sum;
        }
    }
}
