//! The fronts of a multifrontal factorization: the rows of each front and the positions of its entries.
//!
//! A front holds k columns that are eliminated together, and r rows below them. Its part of L is stored in blocks of
//! eight rows, the columns of a block one after the other; both the k and the r rows begin a block. The Schur
//! complement that elimination leaves for the rows below (the *update*, r × r) is kept on a stack until the parent adds
//! it. There are two stacks, which alternate with the depth in the tree.

use super::Lower;
use super::elimination::NONE;
use super::kernel::H;
use std::ops::Range;

#[derive(Clone, Debug)]
pub(crate) struct Front {
    /// The first column.
    pub(crate) first: usize,
    /// k, the number of columns.
    pub(crate) columns: usize,
    /// The rows below, in `FrontPlan::rows`.
    pub(crate) rows: Range<usize>,
    /// The part of L, in columns of eight rows.
    pub(crate) l: Range<usize>,
    /// The stack of the update, and the offset of the update there in columns of eight rows.
    pub(crate) stack: usize,
    pub(crate) update: Range<usize>,
    pub(crate) children: Range<usize>,
    /// The entries of A in these columns, in `FrontPlan::entries`.
    pub(crate) entries: Range<usize>,
}

impl Front {
    /// Number of blocks of the k rows.
    pub(crate) fn pivot_blocks(&self) -> usize {
        self.columns.div_ceil(H)
    }

    /// Number of blocks of the r rows.
    pub(crate) fn row_blocks(&self) -> usize {
        self.rows.len().div_ceil(H)
    }

    /// The position of column 0 of row `place` in the front's part of L. The places count the k rows, rounded up to
    /// whole blocks, and then the r rows.
    #[inline(always)]
    pub(crate) fn row_in_l(&self, place: usize) -> usize {
        place / H * H * self.columns + place % H
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct FrontPlan {
    /// The rows of the matrix that are factored in fronts.
    pub(crate) range: Range<usize>,
    /// Children before parents.
    pub(crate) fronts: Vec<Front>,
    /// The rows below of all fronts, counted from the start of the range.
    pub(crate) rows: Vec<u32>,
    /// The places of these rows in the parent's front.
    pub(crate) places: Vec<u32>,
    pub(crate) children: Vec<u32>,
    /// The slot of a value of A, and its position in its front's part of L.
    pub(crate) entries: Vec<(u32, u32)>,
    pub(crate) l_len: usize,
    pub(crate) stack_len: [usize; 2],
    pub(crate) most_rows: usize,
    pub(crate) most_columns: usize,
}

impl FrontPlan {
    /// The plan for rows that are coupled with no row outside, in fronts of the given numbers of columns.
    pub(crate) fn new(a: &Lower, range: Range<usize>, widths: &[u32]) -> Self {
        let mut plan = FrontPlan { range: range.clone(), ..FrontPlan::default() };
        let mut front_of = Vec::with_capacity(range.len());
        for (f, &width) in widths.iter().enumerate() {
            front_of.resize(front_of.len() + width as usize, f as u32);
        }
        let columns = by_column(a, &range);
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); widths.len()];
        let mut parent = vec![NONE; widths.len()];
        let mut seen = vec![NONE; range.len()];
        let mut first = 0;
        for (f, &width) in widths.iter().enumerate() {
            let end = first + width as usize;
            let begin = plan.rows.len();
            let mut see = |row: u32, rows: &mut Vec<u32>| {
                if row as usize >= end && seen[row as usize] != f as u32 {
                    seen[row as usize] = f as u32;
                    rows.push(row);
                }
            };
            for &(row, _, _) in &columns.1[columns.0[first]..columns.0[end]] {
                see(row, &mut plan.rows);
            }
            for &child in &children[f] {
                for k in plan.fronts[child as usize].rows.clone() {
                    see(plan.rows[k], &mut plan.rows);
                }
            }
            plan.rows[begin..].sort_unstable();
            if let Some(&row) = plan.rows.get(begin) {
                parent[f] = front_of[row as usize];
                children[parent[f] as usize].push(f as u32);
            }
            plan.add(first, width as usize, begin, &children[f], &columns.1[columns.0[first]..columns.0[end]]);
            first = end;
        }
        plan.place_rows(&parent);
        plan.place_updates(&parent);
        plan
    }

    /// Memory of L [bytes].
    #[cfg(test)]
    pub(crate) fn memory(&self) -> usize {
        let numbers = self.l_len + self.stack_len[0] + self.stack_len[1];
        8 * H * numbers + 8 * (self.rows.len() + self.entries.len()) + size_of::<Front>() * self.fronts.len()
    }

    fn add(&mut self, first: usize, columns: usize, begin: usize, children: &[u32], entries: &[(u32, u32, u32)]) {
        let rows = begin..self.rows.len();
        let blocks = columns.div_ceil(H) + rows.len().div_ceil(H);
        let l = self.l_len..self.l_len + blocks * columns;
        let from = self.children.len();
        self.children.extend(children);
        let mut front = Front {
            first,
            columns,
            rows: rows.clone(),
            l: l.clone(),
            stack: 0,
            update: 0..0,
            children: from..self.children.len(),
            entries: self.entries.len()..self.entries.len() + entries.len(),
        };
        for &(row, column, slot) in entries {
            let place = match (row as usize).checked_sub(first + columns) {
                None => row as usize - first,
                Some(_) => {
                    columns.next_multiple_of(H) + self.rows[rows.clone()].binary_search(&row).unwrap_or_default()
                }
            };
            self.entries.push((slot, (front.row_in_l(place) + (column as usize - first) * H) as u32));
        }
        front.entries.end = self.entries.len();
        self.l_len = l.end;
        self.most_rows = self.most_rows.max(rows.len());
        self.most_columns = self.most_columns.max(columns);
        self.fronts.push(front);
    }

    /// Finds the positions of the rows of each front in its parent.
    fn place_rows(&mut self, parent: &[u32]) {
        self.places = vec![0; self.rows.len()];
        for (f, front) in self.fronts.iter().enumerate() {
            if parent[f] == NONE {
                continue;
            }
            let up = &self.fronts[parent[f] as usize];
            let above = &self.rows[up.rows.clone()];
            let mut next = 0;
            for k in front.rows.clone() {
                let row = self.rows[k] as usize;
                if row < up.first + up.columns {
                    self.places[k] = (row - up.first) as u32;
                } else {
                    while above[next] as usize != row {
                        next += 1;
                    }
                    self.places[k] = (up.columns.next_multiple_of(H) + next) as u32;
                }
            }
        }
    }

    /// Assigns a stack position to each update. The updates of the children of a front are the last entries of one
    /// stack; the update of the front lies on the other stack.
    fn place_updates(&mut self, parent: &[u32]) {
        for f in (0..self.fronts.len()).rev() {
            if parent[f] != NONE {
                self.fronts[f].stack = 1 - self.fronts[parent[f] as usize].stack;
            }
        }
        let mut top = [0; 2];
        for f in 0..self.fronts.len() {
            let children = self.fronts[f].children.clone();
            let stack = self.fronts[f].stack;
            let begin = top[stack];
            top[stack] += self.fronts[f].row_blocks() * H * self.fronts[f].row_blocks();
            self.stack_len[stack] = self.stack_len[stack].max(top[stack]);
            self.fronts[f].update = begin..top[stack];
            if let Some(&child) = self.children[children].first() {
                top[1 - stack] = self.fronts[child as usize].update.start;
            }
        }
    }
}

/// The entries of the lower triangle by columns: row, column and slot, numbers counted from the start of the range.
fn by_column(a: &Lower, range: &Range<usize>) -> (Vec<usize>, Vec<(u32, u32, u32)>) {
    let first = range.start as u32;
    let mut start = vec![0; range.len() + 1];
    for i in range.clone() {
        for &(column, _) in a.row(i) {
            start[(column - first) as usize + 1] += 1;
        }
    }
    for k in 0..range.len() {
        start[k + 1] += start[k];
    }
    let mut next = start.clone();
    let mut entries = vec![(0, 0, 0); start[range.len()]];
    for i in range.clone() {
        for &(column, slot) in a.row(i) {
            let place = &mut next[(column - first) as usize];
            entries[*place] = (i as u32 - first, column - first, slot);
            *place += 1;
        }
    }
    (start, entries)
}
