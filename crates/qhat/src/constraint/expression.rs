//! ExpressionConstraint: a constraint C(q, t) = 0 that the user writes as text; one row. The text determines the unit
//! \[C\].
//!
//! ```text
//! C, Ċ = J q̇ + C_t, γ = (∂(Jq̇)/∂q) q̇ + 2 J_t q̇ + C_tt, J and C_t     in two passes over the expression
//! ∂²C/∂q²     in one pass for each coordinate; the sign of −λ ∂²C/∂q² is not known
//! ```
//!
//! A user with several residuals adds several constraints, so that each row has its own particles and its own scale.
//!
//! The scale is the change of C, to second order, when one particle moves by the length L of the system [m]:
//!
//! ```text
//! scale = max_i max(|∂C/∂x_i| L, ½ |∂²C/∂x_i²| L²)     at the start, unless given [C]; |∂²C/∂x_i²|: the largest entry
//! ```
//!
//! With this scale a tolerance means the same for `dist(a, b) - r`, for its square, for a thousand times it, and for a
//! square whose gradient vanishes where the constraint holds. The scale is measured once, when the constraint is made.
//!
//! Fails where C or a derivative is not finite. At the start this is an error of the builder. Later the whole row
//! becomes NaN, so that no method mistakes it for zero, and the step ends in `StepError`.

use super::{ConstraintError, Formulation, Holds, RowWriter};
use crate::expression::{Expression, LONGEST_GRADIENT};
use crate::linalg::block::Block;
use crate::point::{Motion, Point, norm};
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

/// An expression that is held at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpressionConstraint {
    expression: Expression,
    /// The size of the derivatives of C at the start.
    start: Start,
    /// The scale \[C\], if one was given.
    scale: Option<f64>,
}

/// max |∂C/∂x_i| [C/m] and the largest entry of any ∂²C/∂x_i² [C/m²] at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Start {
    slope: f64,
    bend: f64,
    is_finite: bool,
}

impl ExpressionConstraint {
    /// A constraint that holds an expression at zero. `positions` has the positions of all particles at the start
    /// \[m\], d·n numbers. The scale of the row is measured at these positions and t = 0.
    pub fn new(expression: Expression, positions: &[f64]) -> Self {
        let d = expression.dimension();
        // The builder rejects a particle that does not exist.
        let is_there = expression.particles().iter().all(|id| d * (id.0 + 1) <= positions.len());
        let start = match d {
            _ if !is_there => Start { slope: 0.0, bend: 0.0, is_finite: true },
            2 => Start::measure::<2>(&expression, positions),
            _ => Start::measure::<3>(&expression, positions),
        };
        ExpressionConstraint { expression, start, scale: None }
    }

    /// The same constraint with a given scale \[C\], above 0: the |C| that counts as a relative error of one.
    pub fn with_scale(self, scale: f64) -> Self {
        ExpressionConstraint { scale: Some(scale), ..self }
    }

    /// The expression.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }

    /// `Ok` if the expression can be a constraint.
    ///
    /// # Errors
    /// In words: no particle, velocities, numbers that are not finite at the start, no scale.
    pub fn check(&self) -> Result<(), ConstraintError> {
        if self.expression.uses_velocities() {
            return Err(ConstraintError::DependsOnVelocities);
        }
        if self.expression.particles().is_empty() {
            return Err(ConstraintError::DependsOnNothing);
        }
        if !self.start.is_finite {
            return Err(ConstraintError::NotFiniteAtStart);
        }
        match self.scale {
            Some(scale) if scale.is_finite() && scale > 0.0 => Ok(()),
            Some(scale) => Err(ConstraintError::Scale { scale }),
            None if self.start.slope > 0.0 || self.start.bend > 0.0 => Ok(()),
            None => Err(ConstraintError::NeedsScale),
        }
    }
}

impl Start {
    fn measure<const D: usize>(expression: &Expression, q: &[f64]) -> Self {
        let mut gradient = [0.0; LONGEST_GRADIENT];
        // At rest: zeros for every particle would make n constraints take n² numbers.
        let (jet, Ct) = expression.jet_and_gradient(q, &[], 0.0, &mut gradient);
        let gradient = &gradient[..expression.gradient_len()];
        let is_finite = [jet.value, jet.second, Ct].iter().chain(gradient).all(|number| number.is_finite());
        let slope = gradient.chunks_exact(D).map(|g| norm(point::<D>(g))).fold(0.0, f64::max);
        let mut bend = 0.0_f64;
        let mut is_bounded = true;
        expression.hessian_blocks::<D>(Motion { q, qd: &[], t: 0.0 }, &mut |i, j, block| {
            is_bounded &= size(&block).is_finite();
            if i == j {
                bend = block.iter().flatten().fold(bend, |most, entry| most.max(entry.abs()));
            }
        });
        Start { slope, bend, is_finite: is_finite && is_bounded }
    }
}

impl Holds for ExpressionConstraint {
    fn row_count(&self, _: usize) -> usize {
        1
    }

    fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
        super::error::only_in(self.expression.dimension(), dimension)
    }

    fn particles(&self) -> Vec<ParticleId> {
        self.expression.particles().to_vec()
    }

    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
        let mut gradient = [0.0; LONGEST_GRADIENT];
        let (C, Ct) = self.expression.jet_and_gradient(motion.q, motion.qd, motion.t, &mut gradient);
        // Where C has no value, its derivative may still have a value: 1/x, the derivative of ln x, at −1.
        let lost = if C.value.is_finite() { 0.0 } else { f64::NAN };
        let blocks = gradient[..self.expression.gradient_len()].chunks_exact(D);
        let J = blocks.map(|g| point::<D>(g).map(|component| component + lost));
        rows.write_driven(C.value + lost, C.first + lost, C.second + lost, Ct + lost, J);
    }

    fn scale(&self, extent: f64) -> f64 {
        let Start { slope, bend, .. } = self.start;
        self.scale.unwrap_or_else(|| (slope * extent).max(0.5 * bend * extent * extent))
    }

    fn may_jump(&self) -> bool {
        true
    }

    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
        let mut largest = 0.0_f64;
        self.expression.hessian_blocks(motion, &mut |_, _, block: Block<D>| largest = largest.max(size(&block)));
        largest
    }

    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    ) {
        self.expression.hessian_blocks(motion, &mut |i, j, block: Block<D>| {
            visit(i, j, Stiffness::Indefinite(block.map(|row| row.map(|entry| -lambda[0] * entry))));
        });
    }

    /// The text has one form only.
    fn formulated(&self, _: Formulation) -> Self {
        self.clone()
    }

    fn check(&self) -> Result<(), ConstraintError> {
        self.check()
    }
}

fn point<const D: usize>(numbers: &[f64]) -> Point<D> {
    std::array::from_fn(|k| numbers[k])
}

/// The Frobenius norm, an upper bound of the spectral norm.
pub(super) fn size<const D: usize>(block: &Block<D>) -> f64 {
    block.iter().flatten().map(|entry| entry * entry).sum::<f64>().sqrt()
}
