//! Sparse LDLᵀ of a symmetric positive definite matrix of D × D blocks, row of blocks after row of blocks
//! ("up-looking"), in a minimum degree order of the blocks.
//!
//! ```text
//! Y_i = (A_ki − Σ_{j<i} Y_j L_ijᵀ) L_ii⁻ᵀ,   L_ki = Y_i D_i⁻¹,   L_kk D_k L_kkᵀ = A_kk − Σ_{i<k} L_ki Y_iᵀ
//! ```
//!
//! D is diagonal and L_kk unit lower triangular, so the factor has the numbers of the scalar factorization. The inverse
//! of a block pivot is never formed: beside a penalty of 1e8 it loses all its digits. Source: Davis, Algorithm 849, ACM
//! TOMS 31 (2005), with blocks in place of numbers.

use super::block::{
    Block, backward, divide, forward, ldl, load, plus, product_transposed, store, times, transposed, transposed_times,
    vector, zero,
};
use super::{EliminationPlan, Incidence};

/// An entry of the lower triangle of the reordered matrix: its column and the edge that its block comes from.
#[derive(Clone, Copy, Debug)]
struct Entry {
    column: usize,
    edge: usize,
    /// Whether the edge's block must be transposed to stand below the diagonal.
    turned: bool,
}

/// The factor; blocks of L are stored column after column, each with its rows ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockLdl {
    /// The node that is eliminated k-th.
    order: Vec<usize>,
    a_start: Vec<usize>,
    a_entry: Vec<Entry>,
    /// The columns of row k of L, ascending, and the position of each block in column storage.
    row_start: Vec<usize>,
    row_entry: Vec<(usize, usize)>,
    column_start: Vec<usize>,
    row_index: Vec<usize>,
    l: Vec<f64>,
    /// The factor of each block pivot.
    pivot: Vec<f64>,
    /// One dense row of blocks; zero between uses.
    y: Vec<f64>,
    x: Vec<f64>,
}

impl BlockLdl {
    /// The structure for some of the nodes of a graph. The block of an edge (first, second) is A_first,second.
    pub(crate) fn new(nodes: &[usize], edges: &[(usize, usize)], dimension: usize) -> Self {
        let n = nodes.len();
        let mut local = vec![None; nodes.iter().max().map_or(0, |most| most + 1)];
        for (i, &node) in nodes.iter().enumerate() {
            local[node] = Some(i);
        }
        let find = |node: usize| local.get(node).copied().flatten();
        let inside: Vec<(usize, usize, usize)> =
            edges.iter().enumerate().filter_map(|(edge, &(a, b))| Some((find(a)?, find(b)?, edge))).collect();
        // In the words of `Incidence` a node is an unknown, and an edge is a point that two unknowns share.
        let mut touching: Vec<Vec<u32>> = vec![Vec::new(); n];
        for (shared, &(a, b, _)) in inside.iter().enumerate() {
            touching[a].push(shared as u32);
            touching[b].push(shared as u32);
        }
        let order = EliminationPlan::new(&Incidence::new(inside.len(), touching.into_iter())).order;
        let mut place = vec![0; n];
        for (k, &i) in order.iter().enumerate() {
            place[i as usize] = k;
        }
        let mut rows: Vec<Vec<Entry>> = vec![Vec::new(); n];
        for (a, b, edge) in inside {
            let (k, l) = (place[a], place[b]);
            rows[k.max(l)].push(Entry { column: k.min(l), edge, turned: k < l });
        }
        let mut factor = BlockLdl { order: order.iter().map(|&i| nodes[i as usize]).collect(), ..BlockLdl::default() };
        factor.a_start.push(0);
        for mut row in rows {
            row.sort_unstable_by_key(|entry| entry.column);
            factor.a_entry.extend(row);
            factor.a_start.push(factor.a_entry.len());
        }
        factor.find_rows(dimension);
        factor
    }

    /// Finds the blocks of L that are not zero: the elimination tree gives the columns of each row.
    fn find_rows(&mut self, dimension: usize) {
        const NONE: usize = usize::MAX;
        let n = self.order.len();
        let (mut parent, mut seen, mut count) = (vec![NONE; n], vec![NONE; n], vec![0; n]);
        let mut columns: Vec<usize> = Vec::new();
        self.row_start.push(0);
        for k in 0..n {
            seen[k] = k;
            let first = columns.len();
            for entry in &self.a_entry[self.a_start[k]..self.a_start[k + 1]] {
                let mut i = entry.column;
                while seen[i] != k {
                    if parent[i] == NONE {
                        parent[i] = k;
                    }
                    columns.push(i);
                    count[i] += 1;
                    seen[i] = k;
                    i = parent[i];
                }
            }
            columns[first..].sort_unstable();
            self.row_start.push(columns.len());
        }
        self.column_start.push(0);
        for i in 0..n {
            self.column_start.push(self.column_start[i] + count[i]);
        }
        let mut next = self.column_start.clone();
        self.row_index = vec![0; columns.len()];
        for k in 0..n {
            for &i in &columns[self.row_start[k]..self.row_start[k + 1]] {
                self.row_index[next[i]] = k;
                self.row_entry.push((i, next[i]));
                next[i] += 1;
            }
        }
        let block = dimension * dimension;
        self.l = vec![0.0; columns.len() * block];
        self.pivot = vec![0.0; n * block];
        self.y = vec![0.0; n * block];
        self.x = vec![0.0; n * dimension];
    }

    /// Factors the matrix with these blocks on the diagonal (one for each node) and on the edges. Returns false if a
    /// pivot does not exceed `LEAST` times the floor of its node.
    pub(crate) fn factor<const D: usize>(&mut self, diagonal: &[f64], coupling: &[f64], floor: &[f64]) -> bool {
        /// Least positive pivot [floors of the node].
        const LEAST: f64 = 1e-3;
        for k in 0..self.order.len() {
            for entry in &self.a_entry[self.a_start[k]..self.a_start[k + 1]] {
                let A = load::<D>(coupling, entry.edge);
                store(&mut self.y, entry.column, if entry.turned { transposed(&A) } else { A });
            }
            let mut pivot = load::<D>(diagonal, self.order[k]);
            for &(i, place) in &self.row_entry[self.row_start[k]..self.row_start[k + 1]] {
                let own = load::<D>(&self.pivot, i);
                let Y = load::<D>(&self.y, i).map(|row| forward(&own, row));
                store(&mut self.y, i, zero::<D>());
                for p in self.column_start[i]..place {
                    subtract_product(&mut self.y, self.row_index[p], &Y, &self.l, p);
                }
                let L = Y.map(|row| divide(&own, row));
                pivot = plus(pivot, -1.0, product_transposed(&L, &Y));
                store(&mut self.l, place, L);
            }
            match ldl(&pivot, LEAST * floor[self.order[k]]) {
                Some(factor) => store(&mut self.pivot, k, factor),
                None => return false,
            }
        }
        true
    }

    /// r ← A⁻¹ r, for the blocks of its nodes.
    pub(crate) fn solve<const D: usize>(&mut self, r: &mut [f64]) {
        for (own, &node) in self.x.chunks_exact_mut(D).zip(&self.order) {
            own.copy_from_slice(&r[node * D..][..D]);
        }
        for i in 0..self.order.len() {
            let x = forward(&load::<D>(&self.pivot, i), vector(&self.x, i));
            self.x[i * D..][..D].copy_from_slice(&x);
            for p in self.column_start[i]..self.column_start[i + 1] {
                let change = times(&load::<D>(&self.l, p), x);
                for (target, change) in self.x[self.row_index[p] * D..][..D].iter_mut().zip(change) {
                    *target -= change;
                }
            }
        }
        for i in (0..self.order.len()).rev() {
            let own = load::<D>(&self.pivot, i);
            let mut x = divide(&own, vector(&self.x, i));
            for p in self.column_start[i]..self.column_start[i + 1] {
                let change = transposed_times(&load::<D>(&self.l, p), vector(&self.x, self.row_index[p]));
                x = std::array::from_fn(|k| x[k] - change[k]);
            }
            self.x[i * D..][..D].copy_from_slice(&backward(&own, x));
        }
        for (own, &node) in self.x.chunks_exact(D).zip(&self.order) {
            r[node * D..][..D].copy_from_slice(own);
        }
    }
}

/// y_j ← y_j − Y Lᵀ, where L is the p-th stored block.
#[inline(always)]
fn subtract_product<const D: usize>(y: &mut [f64], j: usize, Y: &Block<D>, l: &[f64], p: usize) {
    let L = load::<D>(l, p);
    let target = &mut y[j * D * D..][..D * D];
    for row in 0..D {
        for column in 0..D {
            let mut sum = Y[row][0] * L[column][0];
            for k in 1..D {
                sum += Y[row][k] * L[column][k];
            }
            target[row * D + column] -= sum;
        }
    }
}
