//! The classical Runge–Kutta method, as a tableau: order 4, not symmetric.
//!
//! Stable while h ω < 2.83. λ is exact at every stage, so C drifts only by the method's own error.
//! Source: Kutta (1901).

use super::StepWork;
use crate::integrate::field::{Field, GeneralField, unpack};
use crate::integrate::frame::Frame;
use crate::integrate::runge_kutta::{Tableau, advance};
use crate::state::State;

pub(crate) static RK4: Tableau =
    Tableau::new(&[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]], &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]);

pub(crate) fn step<const D: usize>(frame: &mut Frame<'_>, state: &State) -> StepWork {
    let (system, h) = (frame.system, frame.length);
    let workspace = &mut *frame.workspace;
    workspace.set_modes(system, state);
    let is_factored = system.feedback.diagonal_drag == 0.0 && workspace.is_factored_at(state);
    let mut stages = std::mem::take(&mut workspace.stages);
    let mut field = GeneralField::<D>::new(system, workspace, system.feedback, is_factored);
    stages.resize(field.blocks());
    field.begin(state, &mut stages.q, &mut stages.qd);
    // The general field always has an answer.
    let work = advance(&RK4, &mut field, &mut stages, state.t, h).unwrap_or_default();
    unpack(&stages.next_q, &mut workspace.q);
    unpack(&stages.next_qd, &mut workspace.qd);
    workspace.stages = stages;
    work
}
