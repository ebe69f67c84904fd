//! The classical Runge–Kutta method: order 4, not symmetric.
//!
//! ```text
//! k_i = q̈(q + c_i h q̇_{i−1}, q̇ + c_i h k_{i−1}),   c = 0, ½, ½, 1,   weights 1/6, 1/3, 1/3, 1/6
//! ```
//!
//! Stable while h ω < 2.83. λ is exact at every stage, so C drifts only by the method's own error.
//! Source: Kutta (1901).

use super::{StepWork, Workspace};
use crate::measure;
use crate::point::Motion;
use crate::state::State;
use crate::system::System;

/// c_i, weight of stage i.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0 / 6.0), (0.5, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.0, 1.0 / 6.0)];

/// The motion at a stage, and the slope before it.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    q: Vec<f64>,
    qd: Vec<f64>,
    slope: Vec<f64>,
}

impl Stages {
    pub(super) fn new(coordinates: usize) -> Self {
        Stages { q: vec![0.0; coordinates], qd: vec![0.0; coordinates], slope: vec![0.0; coordinates] }
    }
}

pub(super) fn step<const D: usize>(system: &System, state: &State, h: f64, workspace: &mut Workspace) -> StepWork {
    let Workspace { equation, q, qd, rk4: stage, .. } = workspace;
    q.copy_from_slice(&state.q);
    qd.copy_from_slice(&state.qd);
    stage.qd.copy_from_slice(&state.qd);
    stage.slope.fill(0.0);
    let mut work = StepWork { dissipation: 0.0, stabilization: 0.0 };
    for (c, weight) in STAGES {
        for k in 0..q.len() {
            stage.q[k] = state.q[k] + c * h * stage.qd[k];
            stage.qd[k] = state.qd[k] + c * h * stage.slope[k];
        }
        let motion = Motion::<D> { q: &stage.q, qd: &stage.qd };
        equation.solve(system, motion, &system.feedback, false);
        stage.slope.copy_from_slice(&equation.qdd);
        for k in 0..q.len() {
            q[k] += weight * h * stage.qd[k];
            qd[k] += weight * h * stage.slope[k];
        }
        let power: f64 = equation.Q_hat.iter().zip(&stage.qd).map(|(force, velocity)| force * velocity).sum();
        work.dissipation += weight * h * measure::dissipation(system, motion);
        work.stabilization += weight * h * power;
    }
    work
}
