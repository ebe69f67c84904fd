//! Explicit Euler, the method of the original simulator: order 1, not symmetric.
//!
//! ```text
//! q' = q + h q̇,   q̇' = q̇ + h q̈(q, q̇, t)
//! ```
//!
//! Unstable for every undamped oscillation, however small h: energy grows, rods drift. It is kept because it shows what
//! feedback, diagonal drag and elasticity were needed for.

use super::StepWork;
use crate::energy;
use crate::integrate::Workspace;
use crate::integrate::frame::Frame;
use crate::point::Motion;
use crate::state::State;

pub(crate) fn step<const D: usize>(frame: &mut Frame<'_>, state: &State) -> StepWork {
    let (system, h) = (frame.system, frame.length);
    frame.workspace.solve::<D>(system, state, &system.feedback);
    let Workspace { equation, q, qd, .. } = &mut *frame.workspace;
    for k in 0..q.len() {
        q[k] = state.q[k] + h * state.qd[k];
        qd[k] = state.qd[k] + h * equation.qdd[k];
    }
    work_of_step::<D>(frame, state)
}

/// The work while velocities go from q̇ to q̇' under constant forces [J]: h Q̂·(q̇ + q̇')/2, which is exact, for the
/// constraint force; the trapezoidal rule for dissipative forces. Drives have their share of the constraint force's
/// work, with C_t where the step begins.
pub(crate) fn work_of_step<const D: usize>(frame: &Frame<'_>, state: &State) -> StepWork {
    let Frame { system, workspace, length: h, .. } = frame;
    let before = energy::dissipation(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t }, &[]);
    let after = energy::dissipation(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: state.t + h }, &[]);
    let mut power = 0.0;
    for (k, force) in workspace.equation.Q_hat.iter().enumerate() {
        power += force * 0.5 * (state.qd[k] + workspace.qd[k]);
    }
    let drives = h * workspace.equation.drive_power(system, &system.feedback);
    StepWork { dissipation: 0.5 * h * (before + after), stabilization: h * power - drives, drives }
}
