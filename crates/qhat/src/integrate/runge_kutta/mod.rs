//! Explicit Runge–Kutta methods on the equation itself: λ is solved for at every stage.
//!
//! ```text
//! q_i = q + h Σ_{j<i} a_ij q̇_j,   q̇_i = q̇ + h Σ_{j<i} a_ij k_j,   k_i = q̈(q_i, q̇_i, t + c_i h)
//! q'  = q + h Σ b_i q̇_i,          q̇'  = q̇ + h Σ b_i k_i
//! ```
//!
//! The q̇_j are combinations of the k themselves, so only the k are kept (Nyström's arrangement of the same method):
//!
//! ```text
//! q_i = q + h c_i q̇ + h² Σ_l (A²)_il k_l,   q' = q + h q̇ + h² Σ_l (bᵀA)_l k_l,   c_i = Σ_j a_ij
//! ```
//!
//! A pair adds weights e_i that estimate the local error, e = h Σ e_i (q̇_i, k_i). It takes substeps by that estimate,
//! and projects q' onto C = 0 and q̇' onto Ċ = 0 after each. The projection does not change the order: q' misses C = 0
//! by no more than the method's own error.
//!
//! `tableau.rs` holds the coefficients, `combine.rs` the sums over slopes.

mod combine;
mod tableau;
#[cfg(test)]
mod tests;

pub(super) use combine::Squares;
pub(super) use tableau::{Combination, Tableau};

use super::field::{Field, Power};
use super::fixed::StepWork;
use crate::linalg::eight::{F8, Largest, vector_unit};
use combine::Combine;
use tableau::STAGES;

/// Number [m or m/s] above which squares and their products leave the range of f64: J and A are made of squares, and of
/// their products.
const OVERFLOW: f64 = 1e60;

/// A motion, the one that is tried from it, and the stages between them.
#[derive(Clone, Debug, Default)]
pub(super) struct Stages {
    pub(super) q: Vec<F8>,
    pub(super) qd: Vec<F8>,
    pub(super) next_q: Vec<F8>,
    pub(super) next_qd: Vec<F8>,
    stage_q: Vec<F8>,
    stage_qd: Vec<F8>,
    slope: Vec<Vec<F8>>,
    power: [Power; STAGES],
    /// Whether the first slope is that of the motion at hand.
    pub(super) is_first_known: bool,
}

impl Stages {
    /// Arrays of a number of blocks of eight numbers.
    pub(super) fn new(blocks: usize) -> Self {
        let array = || vec![F8::ZERO; blocks];
        Stages {
            q: array(),
            qd: array(),
            next_q: array(),
            next_qd: array(),
            stage_q: array(),
            stage_qd: array(),
            slope: vec![array(); STAGES],
            power: [Power::default(); STAGES],
            is_first_known: false,
        }
    }

    /// Makes the arrays again for another number of blocks, and forgets the first slope.
    pub(super) fn resize(&mut self, blocks: usize) {
        if self.q.len() != blocks || self.slope.is_empty() {
            *self = Stages::new(blocks);
        }
        self.is_first_known = false;
    }

    /// Keeps the motion that is tried, in the arrays of the stages.
    pub(super) fn remember(&mut self) {
        self.stage_q.copy_from_slice(&self.next_q);
        self.stage_qd.copy_from_slice(&self.next_qd);
    }

    /// Tries the motion that was kept.
    pub(super) fn recall(&mut self) {
        self.next_q.copy_from_slice(&self.stage_q);
        self.next_qd.copy_from_slice(&self.stage_qd);
    }

    /// Σ |Δ|² of positions and of velocities between the motion that was kept and the one that is tried, over the
    /// coordinates that the field counts.
    pub(super) fn moved<F: Field>(&self, field: &F) -> [f64; 2] {
        vector_unit().dispatch(combine::Moved { field, stages: self })
    }

    /// Whether numbers lost their range within the substep tried last, although they were in range at its start: then a
    /// shorter substep is worth trying.
    pub(super) fn overflow(&self) -> bool {
        let largest = |numbers: &[F8]| vector_unit().dispatch(Largest(numbers));
        let is_within = |numbers: &[F8]| largest(numbers) < OVERFLOW;
        let begins_well = self.is_first_known && [&self.q, &self.qd, &self.slope[0]].into_iter().all(|x| is_within(x));
        let ends_well = [&self.stage_q, &self.stage_qd].into_iter().all(|x| is_within(x));
        begins_well && !ends_well
    }

    /// The motion that was tried becomes the motion at hand.
    pub(super) fn accept(&mut self) {
        std::mem::swap(&mut self.q, &mut self.next_q);
        std::mem::swap(&mut self.qd, &mut self.next_qd);
        self.is_first_known = false;
    }
}

/// Tries one step from t to t + h; `None` if the field has no slope at a stage.
pub(super) fn advance<F: Field>(
    tableau: &Tableau,
    field: &mut F,
    stages: &mut Stages,
    t: f64,
    h: f64,
) -> Option<StepWork> {
    let Stages { q, qd, next_q, next_qd, stage_q, stage_qd, slope, power, is_first_known } = stages;
    if !*is_first_known {
        power[0] = field.accelerate(q, qd, t, &mut slope[0])?;
        *is_first_known = true;
    }
    for i in 1..tableau.stages {
        let (known, rest) = slope.split_at_mut(i);
        let weights = &tableau.at[i];
        Combine { weights, h, q, qd, slope: known, first: 0, out_q: stage_q, out_qd: stage_qd }.write();
        power[i] = field.accelerate(stage_q, stage_qd, t + weights.c * h, &mut rest[0])?;
    }
    Combine { weights: &tableau.end, h, q, qd, slope, first: 0, out_q: next_q, out_qd: next_qd }.write();
    let mut work = StepWork::default();
    for (weight, power) in tableau.end.velocity.iter().zip(power).take(tableau.stages) {
        work.dissipation += weight * h * power.dissipation;
        work.stabilization += weight * h * power.stabilization;
        work.drives += weight * h * power.drives;
    }
    Some(work)
}
