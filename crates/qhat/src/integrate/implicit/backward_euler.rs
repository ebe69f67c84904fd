//! Backward Euler, solved at the end of the step: order 1, dissipates, takes any step.
//!
//! ```text
//! q' = q + h q̇',   q̇' = q̇ + h W (Q(q', q̇') + J(q')ᵀ λ),   C(q') = 0
//! ```
//!
//! then q̇' is projected onto Ċ = 0. The Newton iteration of `newton.rs` solves the step with q* = q, q̇* = q̇ and
//! h_e = h. Oscillations lose energy, the more the longer the step: at 1/60 s a whipping chain of 100 links loses 69 %
//! of its largest kinetic energy in two seconds (`benches/results/workloads.csv`, chain100).
//! Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.3; Tournier et al., Stable Constrained
//! Dynamics (2015).

use super::{Base, Formula};
use crate::settings::Integrator;
use crate::state::State;

pub(crate) const BACKWARD_EULER: Formula = Formula { integrator: Integrator::Implicit, first: base, second: None };

pub(crate) fn base(state: &State, h: f64, base: &mut Base) {
    base.q.copy_from_slice(&state.q);
    base.qd.copy_from_slice(&state.qd);
    base.h_e = h;
}
