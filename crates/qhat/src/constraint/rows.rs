//! All constraints together: C, Ċ, γ (m each) and the block-sparse Jacobian J (m × d·n).
//!
//! A row of J touches the few particles its constraint names; for each it holds one block of d numbers. Which particles
//! those are never changes once a System is built, so the layout is made once and only the numbers are written again.

use super::{Constraint, Holds};
use crate::point::{Motion, Point, add, block, dot, scaled};
use crate::system::ParticleId;

/// Which particles each row touches; row i owns the blocks `start[i]..start[i + 1]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Layout {
    pub(crate) start: Vec<usize>,
    pub(crate) particle: Vec<ParticleId>,
}

impl Layout {
    pub(crate) fn new<'a>(constraints: impl Iterator<Item = &'a Constraint>, dimension: usize) -> Self {
        let mut layout = Layout { start: vec![0], particle: Vec::new() };
        for constraint in constraints {
            for _ in 0..constraint.row_count(dimension) {
                layout.particle.extend(constraint.particles());
                layout.start.push(layout.particle.len());
            }
        }
        layout
    }

    pub(crate) fn row_count(&self) -> usize {
        self.start.len() - 1
    }
}

/// J = ∂C/∂q, m × d·n, stored as one block of d numbers for each particle a row touches. Unit: [C]/m.
#[derive(Clone, Debug, PartialEq)]
pub struct Jacobian {
    pub(crate) layout: Layout,
    pub(crate) blocks: Vec<f64>,
    pub(crate) dimension: usize,
    pub(crate) particle_count: usize,
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

    /// Number of rows, m.
    pub fn row_count(&self) -> usize {
        self.layout.row_count()
    }

    /// Number of columns, d·n.
    pub fn column_count(&self) -> usize {
        self.dimension * self.particle_count
    }

    /// The whole matrix, row after row (m·d·n numbers): for looking at, and for tests.
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

    /// One number of J v.
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

    #[inline(always)]
    pub(crate) fn entry<const D: usize>(&self, e: usize) -> Point<D> {
        std::array::from_fn(|k| self.blocks[e * D + k])
    }
}

/// C, Ċ, γ, C_t and J at one motion.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub(crate) C: Vec<f64>,
    pub(crate) Cd: Vec<f64>,
    pub(crate) gamma: Vec<f64>,
    /// ∂C/∂t [C/s]; zero where a constraint does not move with time.
    pub(crate) Ct: Vec<f64>,
    pub(crate) J: Jacobian,
}

impl Rows {
    pub(crate) fn new(layout: Layout, dimension: usize, particle_count: usize) -> Self {
        let m = layout.row_count();
        Rows {
            C: vec![0.0; m],
            Cd: vec![0.0; m],
            gamma: vec![0.0; m],
            Ct: vec![0.0; m],
            J: Jacobian::new(layout, dimension, particle_count),
        }
    }

    pub(crate) fn evaluate<'a, const D: usize>(
        &mut self,
        constraints: impl Iterator<Item = &'a Constraint>,
        motion: Motion<'_, D>,
    ) {
        let mut writer = RowWriter { rows: self, row: 0, entry: 0 };
        for constraint in constraints {
            // Large systems are made of rods: one function for every kind costs them a fifth more.
            match constraint.as_rod() {
                Some(rod) => rod.evaluate(motion, &mut writer),
                None => constraint.evaluate(motion, &mut writer),
            }
        }
        debug_assert_eq!(writer.row, self.C.len());
    }

    /// out = J v + C_t, the Ċ of another velocity; v is d·n, out is m.
    pub(crate) fn rates<const D: usize>(&self, v: &[f64], out: &mut [f64]) {
        self.J.multiply::<D>(v, out);
        for (rate, Ct) in out.iter_mut().zip(&self.Ct) {
            *rate += Ct;
        }
    }
}

/// Where a constraint writes its rows, in the order of the layout.
pub(crate) struct RowWriter<'a, const D: usize> {
    rows: &'a mut Rows,
    row: usize,
    entry: usize,
}

impl<const D: usize> RowWriter<'_, D> {
    /// One row that does not depend on time: C, Ċ, γ and its blocks of J, one for each particle that the constraint names.
    #[inline(always)]
    pub(crate) fn write<const K: usize>(&mut self, C: f64, Cd: f64, gamma: f64, blocks: [Point<D>; K]) {
        // C_t is zero from the beginning.
        self.put(C, Cd, gamma, blocks);
    }

    /// One row whose blocks come one at a time: `fill` is told which particles they belong to and where to put them, and returns
    /// C, Ċ, γ and C_t.
    pub(crate) fn write_blocks(&mut self, fill: impl FnOnce(&[ParticleId], &mut dyn FnMut(Point<D>)) -> [f64; 4]) {
        let Jacobian { layout, blocks, .. } = &mut self.rows.J;
        let entries = layout.start[self.row]..layout.start[self.row + 1];
        let mut places = blocks[entries.start * D..entries.end * D].chunks_exact_mut(D);
        let [C, Cd, gamma, Ct] = fill(&layout.particle[entries.clone()], &mut |block| {
            places.next().expect("a block for each particle").copy_from_slice(&block);
        });
        debug_assert!(places.next().is_none(), "a block for each particle");
        self.rows.C[self.row] = C;
        self.rows.Cd[self.row] = Cd;
        self.rows.gamma[self.row] = gamma;
        self.rows.Ct[self.row] = Ct;
        self.entry = entries.end;
        self.row += 1;
    }

    /// One row of C(q, t) = 0, with Ċ = J q̇ + C_t and γ = (∂(J q̇)/∂q) q̇ + 2 J_t q̇ + C_tt; the blocks of J may come from an
    /// iterator.
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
