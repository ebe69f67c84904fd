//! Sparse LDLᵀ, row by row ("up-looking"), in a minimum degree order.
//!
//! Row k of L solves L_{<k} D y = A_{k,<k}ᵀ; only the unknowns below k in the elimination tree take part, and which those
//! are is found once. Source: Davis, Algorithm 849: a concise sparse Cholesky factorization package, ACM TOMS 31 (2005).

use super::{Pattern, ordering};

/// P A Pᵀ = L D Lᵀ. Columns of L are stored one after the other, each with its rows ascending.
#[derive(Clone, Debug)]
pub(crate) struct SparseLdl {
    /// `order[k]` is the unknown that is eliminated k-th.
    order: Vec<usize>,
    /// Row k of P A Pᵀ left of and on the diagonal: its columns, and the slots their values come from.
    a_start: Vec<usize>,
    a_entry: Vec<(usize, usize)>,
    /// The columns of row k of L, ascending, and where in column storage the entry goes.
    row_start: Vec<usize>,
    row_entry: Vec<(usize, usize)>,
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    l: Vec<f64>,
    d: Vec<f64>,
    /// One dense row; zero between uses.
    y: Vec<f64>,
}

impl SparseLdl {
    pub(crate) fn new(pattern: &Pattern) -> Self {
        let n = pattern.order();
        let order = ordering::minimum_degree(pattern);
        let (a_start, a_entry) = permuted(pattern, &order);

        // The elimination tree gives the columns of each row of L.
        const NONE: usize = usize::MAX;
        let mut parent = vec![NONE; n];
        let mut seen = vec![NONE; n];
        let mut row_start = vec![0];
        let mut row_columns: Vec<usize> = Vec::new();
        let mut count = vec![0; n];
        for k in 0..n {
            seen[k] = k;
            let first = row_columns.len();
            for &(column, _) in &a_entry[a_start[k]..a_start[k + 1]] {
                let mut i = column;
                while seen[i] != k {
                    if parent[i] == NONE {
                        parent[i] = k;
                    }
                    row_columns.push(i);
                    count[i] += 1;
                    seen[i] = k;
                    i = parent[i];
                }
            }
            // Ascending order is a topological order of the tree.
            row_columns[first..].sort_unstable();
            row_start.push(row_columns.len());
        }

        let mut column_start = vec![0; n + 1];
        for i in 0..n {
            column_start[i + 1] = column_start[i] + count[i];
        }
        let mut next = column_start.clone();
        let mut row_index = vec![0; row_columns.len()];
        let mut row_entry = Vec::with_capacity(row_columns.len());
        for k in 0..n {
            for &i in &row_columns[row_start[k]..row_start[k + 1]] {
                row_index[next[i]] = k;
                row_entry.push((i, next[i]));
                next[i] += 1;
            }
        }
        let l = vec![0.0; row_index.len()];
        SparseLdl {
            order,
            a_start,
            a_entry,
            row_start,
            row_entry,
            column_start,
            row_index,
            l,
            d: vec![0.0; n],
            y: vec![0.0; n],
        }
    }

    pub(crate) fn factor(&mut self, values: &[f64], shift: f64) -> f64 {
        let mut smallest = f64::INFINITY;
        for k in 0..self.order.len() {
            for &(column, slot) in &self.a_entry[self.a_start[k]..self.a_start[k + 1]] {
                self.y[column] += values[slot];
            }
            let mut pivot = self.y[k] + shift;
            self.y[k] = 0.0;
            for &(i, place) in &self.row_entry[self.row_start[k]..self.row_start[k + 1]] {
                let y = self.y[i];
                self.y[i] = 0.0;
                for p in self.column_start[i]..place {
                    self.y[self.row_index[p]] -= self.l[p] * y;
                }
                let l = y / self.d[i];
                pivot -= l * y;
                self.l[place] = l;
            }
            self.d[k] = pivot;
            if pivot.is_nan() || pivot <= 0.0 {
                return pivot;
            }
            smallest = smallest.min(pivot);
        }
        smallest
    }

    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        let n = self.order.len();
        let y = &mut self.y;
        for k in 0..n {
            y[k] = x[self.order[k]];
        }
        for i in 0..n {
            for p in self.column_start[i]..self.column_start[i + 1] {
                y[self.row_index[p]] -= self.l[p] * y[i];
            }
        }
        for i in (0..n).rev() {
            y[i] /= self.d[i];
            for p in self.column_start[i]..self.column_start[i + 1] {
                y[i] -= self.l[p] * y[self.row_index[p]];
            }
        }
        for k in 0..n {
            x[self.order[k]] = y[k];
        }
        y.fill(0.0);
    }
}

/// The lower triangle of P A Pᵀ by rows: for each row its columns and the slots of A their values come from.
fn permuted(pattern: &Pattern, order: &[usize]) -> (Vec<usize>, Vec<(usize, usize)>) {
    let n = order.len();
    let mut place = vec![0; n];
    for (k, &i) in order.iter().enumerate() {
        place[i] = k;
    }
    let mut rows = vec![Vec::new(); n];
    for i in 0..n {
        for slot in pattern.start[i]..pattern.start[i + 1] {
            let (k, l) = (place[i], place[pattern.column[slot]]);
            rows[k.max(l)].push((k.min(l), slot));
        }
    }
    let mut start = vec![0];
    let mut entry = Vec::with_capacity(pattern.len());
    for mut row in rows {
        row.sort_unstable();
        entry.extend(row);
        start.push(entry.len());
    }
    (start, entry)
}
