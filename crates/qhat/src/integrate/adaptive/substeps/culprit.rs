//! Culprit: the error of a frame that comes no farther, with the constraint or particle that is at fault.

use super::{Refusal, Stepper, Substeps};
use crate::drift::{attainable, worst_row};
use crate::energy;
use crate::error::StepError;
use crate::integrate::check_finite;
use crate::integrate::failure::{
    at_an_edge, drive_ends, jumps, not_satisfied, rate_jumps, shrinks, without_inactive, without_length,
};
use crate::point::{Motion, largest};
use crate::space::in_dimension;
use crate::state::State;

/// Extents of the system over which an acceleration that has run away would carry a particle within a frame, far above
/// those of stiff springs, whose substeps are merely many.
const AWAY: f64 = 1e12;

impl Substeps<'_> {
    /// The culprit of substeps without end: a driven length that comes to nothing within the frame, or a force without
    /// bound.
    pub(super) fn culprit_of_many(&self, state: &State) -> Option<StepError> {
        shrinks(self.system, state.t, self.start + self.length).or_else(|| self.runaway(state, AWAY))
    }

    /// The error after the shortest substep was not kept: it names the edge that was passed, the particle of the tried
    /// motion that is not finite, the row that jumps, the row with the largest residual, or where all rows are met the
    /// particle with the largest acceleration.
    pub(super) fn failure(
        &self,
        method: &impl Stepper,
        state: &State,
        end: f64,
        refusal: Option<Refusal>,
    ) -> StepError {
        let mut tried = state.clone();
        method.write_tried(&mut tried);
        let (system, time) = (self.system, state.t);
        in_dimension!(system.dimension, D => {
            let motion = Motion::<D> { q: &tried.q, qd: &tried.qd, t: end };
            let lost = || without_length::<D>(system, time, &state.q).or_else(|| shrinks(system, time, end));
            if let Some(error) = at_an_edge(system, state, motion).or_else(lost) {
                return error;
            }
            if let Err(error) = check_finite::<D>(system, time, &tried.q, &tried.qd) {
                return error;
            }
            let jump = || jumps::<D>(system, self.settings, state, end);
            let mut rows = system.rows_at::<D>(state);
            system.evaluate_rows(motion, &mut rows);
            without_inactive(system, state, &mut rows.C);
            let (worst, off) = worst_row(system, &rows.C);
            // A projection goes on to half the tolerance, but what is within the tolerance is not off.
            let within = attainable(system, self.settings, largest(&tried.q)).max(self.settings.constraint_tolerance);
            let is_off = off > within;
            // A drive that reaches the end of its linkage asks for more and more: the other rows come to depend on each
            // other, and no force is large.
            let ends = || drive_ends(system, time, &rows);
            match refusal {
                Some(Refusal::Jump) if is_off => {
                    let (row, residual) = (system.row_names[worst].clone(), rows.C[worst]);
                    return jump().unwrap_or(StepError::Jumps { time, row, residual });
                }
                Some(Refusal::Jump) => {
                    let jump = jump().or_else(|| rate_jumps::<D>(system, self.settings, state, end));
                    return jump.or_else(ends).unwrap_or(StepError::OutOfBalance { time });
                }
                Some(Refusal::Balance) => return ends().unwrap_or(StepError::OutOfBalance { time }),
                None if is_off && off.is_finite() => {
                    let error = not_satisfied(system, time, &rows);
                    // A drive that jumps may be followed at the end of a step.
                    let is_driven = matches!(error, StepError::DriveBlocked { .. });
                    return if is_driven { error } else { jump().unwrap_or(error) };
                }
                _ => {}
            }
            if let Some(error) = jump() {
                return error;
            }
            // Sums of finite numbers may overflow; then no particle is to blame more than another.
            let first = || StepError::NotFinite { time, particle: system.first_moving() };
            self.runaway(state, 1.0).or_else(ends).or_else(|| self.runaway(state, 0.0)).unwrap_or_else(first)
        })
    }

    /// The error that names the particle with the largest acceleration, if that would carry it over more than so many
    /// extents of the system within a frame.
    fn runaway(&self, state: &State, extents: f64) -> Option<StepError> {
        in_dimension!(self.system.dimension, D => {
            let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
            let (particle, acceleration) = energy::most_accelerated(self.system, motion, &state.modes.broken)?;
            // A product that is not a number counts as too far.
            if acceleration * self.length * self.length < extents * self.system.extent {
                return None;
            }
            let particle = self.system.particle_names[particle.0].clone();
            Some(StepError::RanAway { time: state.t, particle, acceleration })
        })
    }
}
