//! Symmetric sparse matrices. The lower triangle is stored by rows, each with its columns ascending and its diagonal
//! last.

use super::Incidence;

/// The entries of the lower triangle that may be nonzero. Every diagonal entry is present.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pattern {
    pub(crate) start: Vec<usize>,
    pub(crate) column: Vec<usize>,
}

impl Pattern {
    /// The pattern with these columns in each row; adds the diagonal and sorts.
    #[cfg(test)]
    pub(crate) fn from_rows(rows: Vec<Vec<usize>>) -> Self {
        let mut pattern = Pattern { start: vec![0], column: Vec::new() };
        for (i, mut columns) in rows.into_iter().enumerate() {
            columns.retain(|&j| j < i);
            columns.sort_unstable();
            columns.dedup();
            columns.push(i);
            pattern.column.extend(columns);
            pattern.start.push(pattern.column.len());
        }
        pattern
    }

    /// The coupling matrix of unknowns that share points.
    pub(crate) fn of_incidence(incidence: &Incidence) -> Self {
        let mut pattern = Pattern { start: vec![0], column: Vec::new() };
        let mut columns = Vec::new();
        for k in 0..incidence.unknowns() as u32 {
            incidence.columns(k, &mut columns);
            pattern.column.extend(columns.iter().map(|&column| column as usize));
            pattern.column.push(k as usize);
            pattern.start.push(pattern.column.len());
        }
        pattern
    }

    /// Number of rows.
    pub(crate) fn order(&self) -> usize {
        self.start.len() - 1
    }

    /// Number of stored entries.
    pub(crate) fn len(&self) -> usize {
        self.column.len()
    }

    /// The index at which entry (i, j), j ≤ i, is stored.
    pub(crate) fn slot(&self, i: usize, j: usize) -> Option<usize> {
        let row = &self.column[self.start[i]..self.start[i + 1]];
        row.binary_search(&j).ok().map(|k| self.start[i] + k)
    }

    /// The slot of the diagonal entry of row i.
    #[inline(always)]
    pub(crate) fn diagonal(&self, i: usize) -> usize {
        self.start[i + 1] - 1
    }

    /// out = A x for the matrix with this pattern and these values.
    pub(crate) fn multiply(&self, values: &[f64], x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for i in 0..self.order() {
            let diagonal = self.diagonal(i);
            let mut sum = values[diagonal] * x[i];
            for slot in self.start[i]..diagonal {
                let j = self.column[slot];
                sum += values[slot] * x[j];
                out[j] += values[slot] * x[i];
            }
            out[i] += sum;
        }
    }
}

/// A symmetric sparse matrix, as [`crate::Terms`] shows it. A particle with very many rows couples each of them with
/// every other: its part is kept as the outer products that it is, so that the memory stays in proportion to the number
/// of rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SymmetricMatrix {
    pub(crate) pattern: Pattern,
    pub(crate) values: Vec<f64>,
    pub(crate) outer: OuterProducts,
}

/// Σ_c w_c b_c b_cᵀ over columns c: numbers w, and vectors b with few entries that are not zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OuterProducts {
    weight: Vec<f64>,
    /// The entries of each row, its columns ascending; empty if there are no columns.
    rows: Vec<Vec<(u32, f64)>>,
}

impl OuterProducts {
    /// No entries yet, for `order` rows and columns with these weights.
    pub(crate) fn new(order: usize, weight: Vec<f64>) -> Self {
        let rows = if weight.is_empty() { Vec::new() } else { vec![Vec::new(); order] };
        OuterProducts { weight, rows }
    }

    /// Writes one entry of a vector b; the columns of a row must ascend.
    pub(crate) fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row].push((column as u32, value));
    }

    fn row(&self, i: usize) -> &[(u32, f64)] {
        self.rows.get(i).map_or(&[], Vec::as_slice)
    }

    fn stored(&self) -> usize {
        self.rows.iter().map(Vec::len).sum()
    }

    /// Entry (i, j); `None` where no column has both rows.
    fn get(&self, i: usize, j: usize) -> Option<f64> {
        let (mut left, mut right) = (self.row(i), self.row(j));
        let mut sum = None;
        while let (Some(&(c, a)), Some(&(d, b))) = (left.first(), right.first()) {
            if c == d {
                *sum.get_or_insert(0.0) += self.weight[c as usize] * a * b;
            }
            left = if c <= d { &left[1..] } else { left };
            right = if d <= c { &right[1..] } else { right };
        }
        sum
    }

    /// out += Σ w b bᵀ x.
    fn multiply(&self, x: &[f64], out: &mut [f64]) {
        let mut y = vec![0.0; self.weight.len()];
        for (row, x) in self.rows.iter().zip(x) {
            row.iter().for_each(|&(c, b)| y[c as usize] += b * x);
        }
        y.iter_mut().zip(&self.weight).for_each(|(y, w)| *y *= w);
        for (row, out) in self.rows.iter().zip(out) {
            row.iter().for_each(|&(c, b)| *out += b * y[c as usize]);
        }
    }
}

/// A list of rows of the lower triangle, each a list of pairs: a column and its number.
#[cfg(feature = "serde")]
impl serde::Serialize for SymmetricMatrix {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let may_be_nonzero = |i, j| self.pattern.slot(i, j).is_some() || self.outer.get(i, j).is_some();
        let columns = |i: usize| (0..=i).filter(move |&j| may_be_nonzero(i, j));
        let row = |i: usize| columns(i).map(|j| (j, self.get(i, j))).collect::<Vec<_>>();
        serializer.collect_seq((0..self.order()).map(row))
    }
}

impl SymmetricMatrix {
    /// Number of rows.
    pub fn order(&self) -> usize {
        self.pattern.order()
    }

    /// How many numbers are stored: the entries of the lower triangle that may be nonzero, where the part of a particle
    /// with very many rows counts one number for each row and dimension.
    pub fn stored(&self) -> usize {
        self.pattern.len() + self.outer.stored()
    }

    /// Entry (i, j); zero where the pattern has none.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (row, column) = if j <= i { (i, j) } else { (j, i) };
        let sparse = self.pattern.slot(row, column).map_or(0.0, |slot| self.values[slot]);
        self.outer.get(row, column).map_or(sparse, |outer| sparse + outer)
    }

    /// The whole matrix, row after row, zeros included: for display and for tests.
    pub fn to_dense(&self) -> Vec<f64> {
        let m = self.order();
        let mut dense = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..=i {
                dense[i * m + j] = self.get(i, j);
                dense[j * m + i] = dense[i * m + j];
            }
        }
        dense
    }

    /// out = A x.
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        self.pattern.multiply(&self.values, x, out);
        self.outer.multiply(x, out);
    }
}

/// The lower triangle of P A Pᵀ by rows: the columns of each row and the slots of A that their values come from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lower {
    start: Vec<usize>,
    entry: Vec<(u32, u32)>,
}

impl Lower {
    /// `order[k]` is the unknown that is eliminated k-th; without an order, unknown k is.
    pub(crate) fn new(pattern: &Pattern, order: Option<&[u32]>) -> Self {
        let n = pattern.order();
        let mut place: Vec<u32> = (0..n as u32).collect();
        for (k, &i) in order.unwrap_or_default().iter().enumerate() {
            place[i as usize] = k as u32;
        }
        let mut start = vec![0; n + 1];
        let entries = || (0..n).flat_map(|i| (pattern.start[i]..pattern.start[i + 1]).map(move |slot| (i, slot)));
        let at = |(i, slot): (usize, usize)| {
            let (k, l) = (place[i], place[pattern.column[slot]]);
            (k.max(l) as usize, k.min(l))
        };
        for e in entries() {
            start[at(e).0 + 1] += 1;
        }
        for k in 0..n {
            start[k + 1] += start[k];
        }
        let mut next = start.clone();
        let mut entry = vec![(0, 0); pattern.len()];
        for e in entries() {
            let (row, column) = at(e);
            entry[next[row]] = (column, e.1 as u32);
            next[row] += 1;
        }
        for k in 0..n {
            entry[start[k]..start[k + 1]].sort_unstable();
        }
        Lower { start, entry }
    }

    #[inline(always)]
    pub(crate) fn row(&self, k: usize) -> &[(u32, u32)] {
        &self.entry[self.start[k]..self.start[k + 1]]
    }
}
