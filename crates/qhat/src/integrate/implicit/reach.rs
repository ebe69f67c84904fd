//! Reach: how far from the origin a step can still be solved.
//!
//! A coordinate q is rounded by ε|q|, and so is the residual M (q' − q* − h_e q̇*) − h_e² Q. `residual.rs` allows for
//! that roundoff. Where it is larger than h² q̈, no force can be told from it: every particle would go on as it came,
//! and every constraint would seem to hold.

use super::residual::ROUNDOFF;
use crate::energy;
use crate::error::StepError;
use crate::point::{Motion, largest, norm};
use crate::settings::Integrator;
use crate::state::State;
use crate::system::System;

/// Roundoff of a residual, over the extent of the system, that is refused whatever the forces [1].
const COARSE: f64 = 1e-6;

/// Roundoff over the extent below which no start is refused [1]: forces that almost vanish are no reason near the
/// origin.
const FINE: f64 = 1e-10;

/// Roundoff over h² q̈ that is refused at a start [1].
const HIDDEN: f64 = 0.1;

/// Refuses a state so far from the origin that a step of h [s] would be lost in roundoff.
///
/// # Errors
/// [`StepError::TooFarOut`], of the particle that is farthest out.
pub(super) fn check<const D: usize>(
    system: &System,
    state: &State,
    integrator: Integrator,
    h: f64,
) -> Result<(), StepError> {
    let roundoff = ROUNDOFF * largest(&state.q);
    if roundoff <= FINE * system.extent {
        return Ok(());
    }
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    let is_start = state.carry.is_none();
    let pushed = energy::most_accelerated(system, motion, &[]).map_or(0.0, |(_, acceleration)| h * h * acceleration);
    let is_hidden = is_start && pushed > 0.0 && roundoff > HIDDEN * pushed;
    if roundoff <= COARSE * system.extent && !is_hidden {
        return Ok(());
    }
    let distance = |particle| norm(motion.x(particle));
    let farthest = system.particles().max_by(|&a, &b| distance(a).total_cmp(&distance(b)));
    farthest.map_or(Ok(()), |particle| {
        Err(StepError::TooFarOut {
            time: state.t,
            particle: system.particle_names[particle.0].clone(),
            distance: distance(particle),
            roundoff,
            integrator,
        })
    })
}
