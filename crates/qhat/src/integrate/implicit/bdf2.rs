//! The backward differentiation formula of order 2, with a step that may vary; dissipates far less than backward Euler.
//!
//! ```text
//! q' = q* + h_e q̇',   q̇' = q̇* + h_e W (Q(q', q̇') + J(q')ᵀ λ),   C(q') = 0
//! q* = ((1 + ρ)² q − ρ² q₋)/(1 + 2ρ),  q̇* likewise,   h_e = h (1 + ρ)/(1 + 2ρ),   ρ = h/h₋
//! ```
//!
//! q₋ and q̇₋ are the state before the last step of h₋; for equal steps q* = (4 q − q₋)/3 and h_e = 2h/3. Then q̇' is
//! projected onto Ċ = 0. The first step is one of backward Euler, and so is a step on which Newton's method does not
//! converge soon.
//! Source: Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, III.5.

use super::{Base, Formula, backward_euler};
use crate::settings::Integrator;
use crate::state::{Previous, State};

pub(crate) const BDF2: Formula =
    Formula { integrator: Integrator::Bdf2, first: backward_euler::base, second: Some(base) };

fn base(state: &State, previous: &Previous, h: f64, base: &mut Base) {
    let ratio = h / previous.h;
    let divisor = 1.0 + 2.0 * ratio;
    let (now, then) = ((1.0 + ratio) * (1.0 + ratio) / divisor, ratio * ratio / divisor);
    for k in 0..base.q.len() {
        base.q[k] = now * state.q[k] - then * previous.q[k];
        base.qd[k] = now * state.qd[k] - then * previous.qd[k];
    }
    base.h_e = h * (1.0 + ratio) / divisor;
}
