//! All constraints together: C, Ċ, γ (m each) and the block-sparse Jacobian J (m × d·n).
//!
//! A row of J touches the few particles its constraint names; for each it holds one block of d numbers. Which particles
//! those are never changes once a System is built, so the layout is made once and only the numbers are written again.

use super::jacobian::{Jacobian, RowWriter};
use super::layout::Layout;
use super::{Constraint, Holds};
use crate::point::Motion;

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
