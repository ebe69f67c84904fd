//! J in blocks, one for each particle of a row, and the writer through which a constraint fills its rows.

use super::layout::Layout;
use super::rows::Rows;
use crate::point::{Point, add, block, dot, scaled};
use crate::space::ParticleId;

/// J = ∂C/∂q, m × d·n, stored as one block of d numbers for each particle that a row depends on. Unit: \[C\]/m.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    pub(crate) layout: Layout,
    pub(crate) blocks: Vec<f64>,
    pub(crate) dimension: usize,
    pub(crate) particle_count: usize,
}

/// A list of rows, each a list of pairs: a particle and its d numbers.
#[cfg(feature = "serde")]
impl serde::Serialize for Jacobian {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.row_count()).map(|row| self.row(row).collect::<Vec<_>>()))
    }
}

impl Jacobian {
    pub(crate) fn new(layout: Layout, dimension: usize, particle_count: usize) -> Self {
        let blocks = vec![0.0; layout.particle.len() * dimension];
        Jacobian { layout, blocks, dimension, particle_count }
    }

    /// The blocks of one row: the particle and its d numbers.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (ParticleId, &[f64])> {
        let entries = self.layout.start[row]..self.layout.start[row + 1];
        entries.map(|e| (self.layout.particle[e], &self.blocks[e * self.dimension..][..self.dimension]))
    }

    /// The first m rows alone.
    pub(crate) fn first_rows(&self, m: usize) -> Self {
        let entries = self.layout.start[m];
        let layout =
            Layout { start: self.layout.start[..=m].to_vec(), particle: self.layout.particle[..entries].to_vec() };
        Jacobian { layout, blocks: self.blocks[..entries * self.dimension].to_vec(), ..*self }
    }

    /// Number of rows, m.
    pub fn row_count(&self) -> usize {
        self.layout.row_count()
    }

    /// Number of columns, d·n.
    pub fn column_count(&self) -> usize {
        self.dimension * self.particle_count
    }

    /// The whole matrix, row after row (m·d·n numbers), for display and tests.
    pub fn to_dense(&self) -> Vec<f64> {
        let columns = self.column_count();
        let mut dense = vec![0.0; self.row_count() * columns];
        for row in 0..self.row_count() {
            for (particle, numbers) in self.row(row) {
                for (k, number) in numbers.iter().enumerate() {
                    dense[row * columns + particle.0 * self.dimension + k] += number;
                }
            }
        }
        dense
    }

    /// out = J v; v is d·n, out is m.
    pub(crate) fn multiply<const D: usize>(&self, v: &[f64], out: &mut [f64]) {
        for (row, sum) in out.iter_mut().enumerate() {
            *sum = 0.0;
            for e in self.layout.start[row]..self.layout.start[row + 1] {
                *sum += dot(self.entry::<D>(e), block(v, self.layout.particle[e]));
            }
        }
    }

    /// One component of J v.
    pub(crate) fn multiply_row<const D: usize>(&self, row: usize, v: &[f64]) -> f64 {
        let entries = self.layout.start[row]..self.layout.start[row + 1];
        entries.map(|e| dot(self.entry::<D>(e), block(v, self.layout.particle[e]))).sum()
    }

    /// out += Jᵀ λ; λ is m, out is d·n.
    pub(crate) fn add_transposed<const D: usize>(&self, lambda: &[f64], out: &mut [f64]) {
        for (row, &multiplier) in lambda.iter().enumerate() {
            for e in self.layout.start[row]..self.layout.start[row + 1] {
                add(out, self.layout.particle[e], scaled(multiplier, self.entry::<D>(e)));
            }
        }
    }

    /// out += factor W Jᵀ μ; μ is m, out is d·n. Fixed particles (W = 0) are left as they are.
    pub(crate) fn add_impulse<const D: usize>(&self, W: &[f64], mu: &[f64], factor: f64, out: &mut [f64]) {
        for (row, &multiplier) in mu.iter().enumerate() {
            for e in self.layout.start[row]..self.layout.start[row + 1] {
                let particle = self.layout.particle[e];
                let w = W[particle.0];
                if w > 0.0 {
                    add(out, particle, scaled(factor * w * multiplier, self.entry::<D>(e)));
                }
            }
        }
    }

    #[inline(always)]
    pub(crate) fn entry<const D: usize>(&self, e: usize) -> Point<D> {
        std::array::from_fn(|k| self.blocks[e * D + k])
    }
}

/// The writer of the rows of all constraints, one after the other in the order of the layout.
pub(crate) struct RowWriter<'a, const D: usize> {
    pub(super) rows: &'a mut Rows,
    pub(super) row: usize,
    pub(super) entry: usize,
}

impl<const D: usize> RowWriter<'_, D> {
    /// Writes one row that does not depend on time: C, Ċ, γ and its blocks of J, one for each particle of the
    /// constraint.
    #[inline(always)]
    pub(crate) fn write<const K: usize>(&mut self, C: f64, Cd: f64, gamma: f64, blocks: [Point<D>; K]) {
        // C_t was zero when the rows were made, and stays zero.
        self.put(C, Cd, gamma, blocks);
    }

    /// Writes one row through `fill`. `fill` gets the particles of the row and the slice for their blocks, D numbers
    /// each, and returns C, Ċ, γ and C_t.
    pub(crate) fn write_blocks(&mut self, fill: impl FnOnce(&[ParticleId], &mut [f64]) -> [f64; 4]) {
        let Jacobian { layout, blocks, .. } = &mut self.rows.J;
        let entries = layout.start[self.row]..layout.start[self.row + 1];
        let room = &mut blocks[entries.start * D..entries.end * D];
        let [C, Cd, gamma, Ct] = fill(&layout.particle[entries.clone()], room);
        self.rows.C[self.row] = C;
        self.rows.Cd[self.row] = Cd;
        self.rows.gamma[self.row] = gamma;
        self.rows.Ct[self.row] = Ct;
        self.entry = entries.end;
        self.row += 1;
    }

    /// Writes one row of C(q, t) = 0, with Ċ = J q̇ + C_t and γ = (∂(J q̇)/∂q) q̇ + 2 J_t q̇ + C_tt. The blocks of J
    /// may come from an iterator.
    #[inline(always)]
    pub(crate) fn write_driven(
        &mut self,
        C: f64,
        Cd: f64,
        gamma: f64,
        Ct: f64,
        blocks: impl IntoIterator<Item = Point<D>>,
    ) {
        self.rows.Ct[self.row] = Ct;
        self.put(C, Cd, gamma, blocks);
    }

    #[inline(always)]
    fn put(&mut self, C: f64, Cd: f64, gamma: f64, blocks: impl IntoIterator<Item = Point<D>>) {
        self.rows.C[self.row] = C;
        self.rows.Cd[self.row] = Cd;
        self.rows.gamma[self.row] = gamma;
        for numbers in blocks {
            self.rows.J.blocks[self.entry * D..][..D].copy_from_slice(&numbers);
            self.entry += 1;
        }
        self.row += 1;
        debug_assert_eq!(self.entry, self.rows.J.layout.start[self.row], "a block for each particle");
    }
}
