//! What every kind of constraint answers, and the words in which it answers.

use super::error::ConstraintError;
use super::jacobian::RowWriter;
use crate::force::Force;
use crate::point::Motion;
use crate::space::ParticleId;
use crate::stiffness::Stiffness;
use std::ops::Range;

/// What every constraint answers. [C] is the unit of its residual.
pub(crate) trait Holds {
    /// Number of scalar rows in d dimensions.
    fn row_count(&self, dimension: usize) -> usize;

    /// Whether its rows are the components of a vector, x, y and z, and not several scalars.
    fn is_vector(&self) -> bool {
        false
    }

    /// The particles its rows touch, each once, in the order of the blocks that `evaluate` writes.
    fn particles(&self) -> Vec<ParticleId>;

    /// Writes C, Ċ, γ, C_t and the blocks of J, one row after the other.
    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>);

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// How far its rows give way.
    fn softness(&self) -> Softness {
        Softness::default()
    }

    /// What rows that give way are to a method that does not solve at the end of the step.
    fn as_force(&self) -> Option<Force> {
        None
    }

    /// A bound on the norm of one block of ∂²C/∂q² [C/m²]: times |λ| it is geometric stiffness.
    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `visit(i, j, block)`, i ≤ j counting its particles, with the geometric stiffness −Σ λ ∂²C/∂q² for the
    /// multipliers of its rows [N/m]; not where it is zero.
    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    );

    /// Whether the gradient of a row vanishes on one of its particles only where it vanishes on all: then the row can be
    /// eliminated together with any of them.
    fn pulls_on_each(&self) -> bool {
        false
    }

    /// Which of its rows open and close.
    fn contacts(&self, _dimension: usize) -> Vec<ContactRows> {
        Vec::new()
    }

    /// The tension or thrust that its first row does not survive [N].
    fn breaks_at(&self) -> Option<f64> {
        None
    }

    /// The same constraint in the forms of another formulation.
    fn formulated(&self, formulation: Formulation) -> Self;

    /// `Ok` if it can be in d dimensions.
    fn fits(&self, _dimension: usize) -> Result<(), ConstraintError> {
        Ok(())
    }

    /// `Ok` if its numbers are in range.
    fn check(&self) -> Result<(), ConstraintError>;
}

/// A row of a constraint that opens and closes, C ≥ 0 and λ ≥ 0, with its rows of friction; rows count from its first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactRows {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// e.
    pub(crate) restitution: f64,
    /// μ.
    pub(crate) friction: f64,
}

/// How far a row gives way: C + α λ + α c Ċ = 0. [α] = m/N, [c] = N·s/m for a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Softness {
    /// α ≥ 0; zero is rigid.
    pub(crate) compliance: f64,
    /// c ≥ 0, of a damper beside the compliance.
    pub(crate) damping: f64,
}

impl Softness {
    pub(crate) fn is_rigid(&self) -> bool {
        self.compliance == 0.0
    }

    /// 1 + α c/h: how much faster C must follow where its rate is C/h.
    #[inline(always)]
    pub(crate) fn lag(&self, h: f64) -> f64 {
        1.0 + self.compliance * self.damping / h
    }
}

/// Which forms of the constraints are in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// Length of rods and vector nails: well conditioned wherever the constraint holds.
    Modern,
    /// The source's own: squared distances and scalar nails, whose gradient vanishes exactly where they must hold.
    Classic,
}
