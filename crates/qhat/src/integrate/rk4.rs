//! The classical Runge–Kutta method, as a tableau: order 4, not symmetric.
//!
//! Stable while h ω < 2.83. λ is exact at every stage, so C drifts only by the method's own error.
//! Source: Kutta (1901).

use super::runge_kutta::{Tableau, advance};
use super::{StepWork, Workspace};
use crate::state::State;
use crate::system::System;

const RK4: Tableau<4> =
    Tableau { a: [&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]], b: [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0] };

pub(super) fn step<const D: usize>(system: &System, state: &State, h: f64, workspace: &mut Workspace) -> StepWork {
    let is_factored = system.feedback.diagonal_drag == 0.0 && workspace.factored_at == state.q;
    advance::<D, 4>(&RK4, system, state, h, &system.feedback, is_factored, workspace)
}
