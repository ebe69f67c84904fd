//! Rows: C, Ċ, γ (m each) and the block-sparse Jacobian J (m × d·n) of all constraints together.
//!
//! A row of J depends on the few particles of its constraint and holds one block of d numbers for each of them. Which
//! particles these are never changes once a System is built. The layout is therefore made once, and an evaluation
//! writes numbers only.

use super::feet::Feet;
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
    /// ∂C/∂t [C/s]; zero where a constraint does not depend on time.
    pub(crate) Ct: Vec<f64>,
    pub(crate) J: Jacobian,
    /// Where the feet of beads are sought; empty in a system without beads.
    pub(crate) feet: Feet,
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
            feet: Feet::default(),
        }
    }

    pub(crate) fn evaluate<'a, const D: usize>(
        &mut self,
        constraints: impl Iterator<Item = &'a Constraint>,
        motion: Motion<'_, D>,
    ) {
        let mut writer = RowWriter { rows: self, row: 0, entry: 0 };
        for constraint in constraints {
            // Large systems are made of rods. For them the match over all kinds would take a fifth more time.
            match constraint.as_rod() {
                Some(rod) => rod.evaluate(motion, &mut writer),
                None => match writer.rows.feet.bead(constraint, writer.row, motion.t) {
                    Some(bead) => bead.evaluate(motion, &mut writer),
                    None => constraint.evaluate(motion, &mut writer),
                },
            }
        }
        debug_assert_eq!(writer.row, self.C.len());
    }

    /// out = J v + C_t, the Ċ of the velocity v; v is d·n, out is m.
    pub(crate) fn rates<const D: usize>(&self, v: &[f64], out: &mut [f64]) {
        self.J.multiply::<D>(v, out);
        for (rate, Ct) in out.iter_mut().zip(&self.Ct) {
            *rate += Ct;
        }
    }
}
