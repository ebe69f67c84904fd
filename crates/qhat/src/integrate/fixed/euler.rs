//! Explicit Euler, the source's own: order 1, not symmetric.
//!
//! ```text
//! q' = q + h q̇,   q̇' = q̇ + h q̈(q, q̇, t)
//! ```
//!
//! Unstable for any undamped oscillation, however small h: energy grows, rods drift. Kept because it shows why the source
//! needed feedback, diagonal drag and elasticity.

use super::{StepWork, Workspace};
use crate::energy;
use crate::point::Motion;
use crate::state::State;
use crate::system::System;

pub(crate) fn step<const D: usize>(system: &System, state: &State, h: f64, workspace: &mut Workspace) -> StepWork {
    workspace.solve::<D>(system, state, &system.feedback);
    let Workspace { equation, q, qd, .. } = workspace;
    for k in 0..q.len() {
        q[k] = state.q[k] + h * state.qd[k];
        qd[k] = state.qd[k] + h * equation.qdd[k];
    }
    work_of_kick::<D>(system, state, h, workspace)
}

/// Energy that crossed the border while the velocities went from q̇ to q̇' under constant forces [J]:
/// h Q̂·(q̇ + q̇')/2, which is exact for the constraint force, and the trapezoidal rule for the dissipative ones. Drives have their share of the
/// constraint force's at the C_t where the step begins.
pub(crate) fn work_of_kick<const D: usize>(system: &System, state: &State, h: f64, workspace: &Workspace) -> StepWork {
    let before = energy::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t });
    let after = energy::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: state.t + h });
    let mut power = 0.0;
    for (k, force) in workspace.equation.Q_hat.iter().enumerate() {
        power += force * 0.5 * (state.qd[k] + workspace.qd[k]);
    }
    let drives = h * workspace.equation.drive_power(system, &system.feedback);
    StepWork { dissipation: 0.5 * h * (before + after), stabilization: h * power - drives, drives }
}
