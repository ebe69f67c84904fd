//! The projection of one substep of Radau IIA onto C = 0 and Ċ = 0, and what it may not do: move the motion far, or
//! lead over an edge.

use super::Scratch;
use super::stages::{Stages, Step};
use super::stepper::RadauStepper;
use crate::drift::{attainable, worst_row};
use crate::integrate::adaptive::pair::{norm, reference_speed};
use crate::integrate::edges::Passage;
use crate::point::{Motion, largest};

/// Iterations of one projection. The constraints are off by the error of the step, and the factor belongs to its start:
/// each iteration gains some two digits.
const MOST_PROJECTIONS: usize = 8;

/// Ratio of two residuals of a projection from which on a matrix of the end of the step takes its place.
const DULL: f64 = 0.05;

/// |Ċ|, relative to the speed of the fastest particle over the extent, below which it is roundoff.
const CONSISTENT: f64 = 1e-13;

impl<const D: usize> RadauStepper<'_, D> {
    /// The way that the projection moved the motion, in the norm of the error estimate.
    pub(super) fn moved(&self, h: f64) -> f64 {
        let Scratch { stages, tried_q, tried_qd, .. } = &*self.scratch;
        let squares = |to: &[f64], from: &[f64]| to.iter().zip(from).map(|(to, from)| (to - from) * (to - from)).sum();
        let squares = [squares(&stages.q, tried_q), squares(&stages.qd, tried_qd)];
        norm(self.system, squares, reference_speed(self.system, largest(&stages.qd), h))
    }

    /// Whether the step leads over a place that no substep may pass.
    pub(super) fn passes_an_edge(&self, step: &Step<'_>) -> bool {
        let (system, state) = (self.system, step.state);
        if system.jumpy.is_empty() && system.bead_places.is_empty() {
            return false;
        }
        let Stages { rows, q, qd, .. } = &self.scratch.stages;
        let before = &system.rows_at::<D>(state).J.blocks;
        let from = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let to = Motion::<D> { q, qd, t: step.end };
        Passage { system, rows, inactive: &[], before, from, to }.is_barred()
    }

    /// Moves the last stage onto C = 0 and then Ċ = 0, in the metric of the step's own real matrix: a particle on a
    /// stiff spring then hardly moves along it. Its iterations, or `None` if that was not possible.
    pub(super) fn project(&mut self, step: &Step<'_>) -> Option<usize> {
        let (system, mut iterations, mut last) = (self.system, 0, f64::INFINITY);
        let mut is_sharp = !self.sharpens;
        self.is_ahead = false;
        loop {
            let Scratch { saddle, stages, rhs, .. } = &mut *self.scratch;
            stages.evaluate_rows::<D>(system, step.end);
            let off = worst_row(system, &stages.rows.C).1;
            let is_met = off <= attainable(system, self.settings, largest(&stages.q));
            if is_met && std::mem::replace(&mut is_sharp, true) {
                break;
            }
            if off.is_infinite() || iterations == MOST_PROJECTIONS {
                return None;
            }
            for (rhs, &row) in rhs[saddle.velocities()..].iter_mut().zip(&saddle.rows) {
                *rhs = -stages.rows.C[row];
            }
            self.correct(step, off > DULL * last, |stages| &mut stages.q)?;
            (last, iterations) = (off, iterations + 1);
        }
        last = f64::INFINITY;
        for _ in 0..MOST_PROJECTIONS {
            let Scratch { saddle, stages, rhs, .. } = &mut *self.scratch;
            let mut off = 0.0_f64;
            for (rhs, &row) in rhs[saddle.velocities()..].iter_mut().zip(&saddle.rows) {
                let rate = stages.rows.J.multiply_row::<D>(row, &stages.qd) + stages.rows.Ct[row];
                off = off.max(rate.abs() / system.row_scale[row]);
                *rhs = -rate;
            }
            if off * system.extent <= CONSISTENT * largest(&stages.qd) {
                break;
            }
            self.correct(step, off > DULL * last, |stages| &mut stages.qd)?;
            last = off;
        }
        self.scratch.stages.evaluate_rows::<D>(system, step.end);
        Some(iterations)
    }

    /// Solves for the right-hand side at hand, of the rows alone, and adds the solution to the positions or velocities
    /// `of` the stage. If the matrix `is_dull`, a matrix of the end of the step is made first, once. `None` where it
    /// cannot be factored.
    fn correct(&mut self, step: &Step<'_>, is_dull: bool, of: fn(&mut Stages) -> &mut [f64]) -> Option<()> {
        let Scratch { saddle, factors, stages, rhs, .. } = &mut *self.scratch;
        if is_dull && !self.is_ahead {
            let motion = Motion::<D> { q: &stages.q, qd: &stages.qd, t: step.end };
            saddle.linearize(self.system, motion, &stages.rows, &stages.lambda);
            (self.is_ahead, self.is_linearized, self.factored_for) = (true, false, None);
            if !factors.factor_real::<D>(saddle, step.h) {
                return None;
            }
        }
        rhs[..saddle.velocities()].fill(0.0);
        factors.solve(saddle, rhs);
        saddle.add_to::<D>(rhs, of(stages));
        Some(())
    }
}
