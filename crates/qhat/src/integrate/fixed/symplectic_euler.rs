//! Semi-implicit Euler: order 1, not symmetric.
//!
//! ```text
//! q̇' = q̇ + h q̈(q, q̇, t),   q' = q + h q̇'
//! ```
//!
//! Symplectic for forces that depend on q alone: energy oscillates instead of growing while h ω < 2. Constraints
//! drift to first order, so the method needs feedback: stable for kd h < 2 and ks h² + 2 kd h < 4.

use super::StepWork;
use super::euler::work_of_step;
use crate::integrate::Workspace;
use crate::integrate::frame::Frame;
use crate::state::State;

pub(crate) fn step<const D: usize>(frame: &mut Frame<'_>, state: &State) -> StepWork {
    let (system, h) = (frame.system, frame.length);
    frame.workspace.solve::<D>(system, state, &system.feedback);
    let Workspace { equation, q, qd, .. } = &mut *frame.workspace;
    for k in 0..q.len() {
        qd[k] = state.qd[k] + h * equation.qdd[k];
        q[k] = state.q[k] + h * qd[k];
    }
    work_of_step::<D>(frame, state)
}
