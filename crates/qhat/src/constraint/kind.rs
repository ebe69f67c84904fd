//! Kind: the questions that every kind of constraint answers, and the types of the answers.

use super::error::ConstraintError;
use super::jacobian::RowWriter;
use crate::force::Force;
use crate::point::Motion;
use crate::space::ParticleId;
use crate::stiffness::Stiffness;
use std::ops::Range;

/// The questions that every constraint answers. [C] is the unit of its residual.
pub(crate) trait Holds {
    /// Number of scalar rows in d dimensions.
    fn row_count(&self, dimension: usize) -> usize;

    /// Whether the rows are the components x, y and z of one vector. Otherwise they are separate scalars.
    fn is_vector(&self) -> bool {
        false
    }

    /// The particles that each row depends on, each once, in the order of the blocks that `evaluate` writes.
    fn particles(&self) -> Vec<ParticleId>;

    /// Writes C, Ċ, γ, C_t and the blocks of J, row after row.
    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>);

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// The softness of the rows.
    fn softness(&self) -> Softness {
        Softness::default()
    }

    /// The force that replaces soft rows in methods that are not implicit.
    fn as_force(&self) -> Option<Force> {
        None
    }

    /// A bound on the norm of one block of ∂²C/∂q² [C/m²]. Times |λ| it bounds the geometric stiffness.
    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `visit(i, j, block)` with the blocks of the geometric stiffness −Σ λ ∂²C/∂q² [N/m] for the multipliers of
    /// the rows. i ≤ j are places in `particles`. Zero blocks may be left out.
    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    );

    /// Whether the gradient of a row vanishes on one of its particles only where it vanishes on all of them. Such a
    /// row can be eliminated together with any of its particles.
    fn pulls_on_each(&self) -> bool {
        false
    }

    /// L/EA [m/N] of a row that is a rod, with its length L and its stiffness EA; zero for a row that is none. It
    /// weighs the share of redundant rods, and no rod is softer for it.
    fn flexibility(&self, _row: usize, _t: f64) -> f64 {
        0.0
    }

    /// The rows that open and close, at most two.
    fn contacts(&self, _dimension: usize) -> [Option<ContactRows>; 2] {
        [None, None]
    }

    /// The tension or thrust of the first row at which the constraint breaks [N].
    fn breaks_at(&self) -> Option<f64> {
        None
    }

    /// The impulse in the first row at which the constraint breaks [N·s].
    fn breaks_at_impulse(&self) -> Option<f64> {
        None
    }

    /// Whether the gradient may jump, or lose its value, at places that the motion can reach.
    fn may_jump(&self) -> bool {
        false
    }

    /// The ends of the vectors whose directions are in the gradient, if they may shrink to nothing.
    fn arms(&self) -> Vec<[ParticleId; 2]> {
        Vec::new()
    }

    /// The least driven radius, half axis or length of a rod at t [m], which must stay above zero; infinite where there
    /// is none.
    fn least_size(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// The same constraint in the form that belongs to a formulation.
    fn formulated(&self, formulation: Formulation) -> Self;

    /// `Ok` if the constraint has a meaning in d dimensions; the error says why it has none.
    fn fits(&self, _dimension: usize) -> Result<(), ConstraintError> {
        Ok(())
    }

    /// `Ok` if the numbers of the constraint are allowed; the error names the number that is not.
    fn check(&self) -> Result<(), ConstraintError>;
}

/// A contact of a constraint: a row that opens and closes, C ≥ 0 and λ ≥ 0, with its rows of friction. Rows count
/// from the first row of the constraint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactRows {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// e, the coefficient of restitution.
    pub(crate) restitution: f64,
    /// μ of Coulomb's law.
    pub(crate) friction: f64,
}

/// The softness of a row: C + α λ + α c Ċ = 0. [α] = m/N and [c] = N·s/m for a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Softness {
    /// α ≥ 0; zero is rigid.
    pub(crate) compliance: f64,
    /// c ≥ 0 of a damper parallel to the compliance.
    pub(crate) damping: f64,
}

impl Softness {
    pub(crate) fn is_rigid(&self) -> bool {
        self.compliance == 0.0
    }

    /// 1 + α c/h: the factor by which the damper multiplies C if the rate Ċ is C/h.
    #[inline(always)]
    pub(crate) fn lag(&self, h: f64) -> f64 {
        1.0 + self.compliance * self.damping / h
    }
}

/// The form of the constraints: well conditioned, or as in the program from which this engine descends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// The length form of rods and the vector form of nails: well conditioned wherever the constraint holds.
    Modern,
    /// The form of the source: squared distances, and scalar nails, whose gradient vanishes exactly where C = 0.
    Classic,
}
