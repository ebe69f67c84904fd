//! Semi-implicit Euler: order 1, not symmetric.
//!
//! ```text
//! q̇' = q̇ + h q̈(q, q̇, t),   q' = q + h q̇'
//! ```
//!
//! Symplectic for forces that depend on q alone: energy oscillates instead of growing while h ω < 2. Off the constraints it
//! drifts to first order, so it needs feedback: stable for kd h < 2 and ks h² + 2 kd h < 4.

use super::euler::work_of_kick;
use super::{StepWork, Workspace};
use crate::state::State;
use crate::system::System;

pub(crate) fn step<const D: usize>(system: &System, state: &State, h: f64, workspace: &mut Workspace) -> StepWork {
    workspace.solve::<D>(system, state, &system.feedback);
    let Workspace { equation, q, qd, .. } = workspace;
    for k in 0..q.len() {
        qd[k] = state.qd[k] + h * equation.qdd[k];
        q[k] = state.q[k] + h * qd[k];
    }
    work_of_kick::<D>(system, state, h, workspace)
}
