//! Auto: DOP853 where its substeps fit into the work allowed for a frame, BDF2 where they do not.
//!
//! A chain with beads m and links L under tension T swings at up to ω = 2√(T/(m L)), and an explicit method must
//! follow it with h ω of about 5. ω grows with the root of the load, and so does the number of substeps in a frame. A
//! frame whose substeps run out of work is finished by BDF2, and BDF2 stays for some frames before DOP853 is tried
//! again: under a load of a billion beads for a quarter of all frames or more (`tests/auto.rs`). The work is counted in
//! row solves, not in seconds: the same input gives the same bits.
//!
//! BDF2 loses energy, and the fast oscillations that h cannot show; rods hold all the same. The report names the
//! integrator that advanced the frame.

use super::adaptive::{dop853, pair_frame};
use super::frame::Frame;
use super::implicit::{self, bdf2};
use crate::error::StepError;
use crate::report::{StepReport, Warning};
use crate::settings::{Integrator, Settings};
use crate::state::State;
use crate::system::System;

/// Frames for which BDF2 stays before DOP853 is tried again: half a second at 60 frames a second, with a thirtieth of
/// the work lost on trying.
const REST: u32 = 30;

/// Cost of a row on the general path, in rows of `chains/`: 79 to 86 ns a stage in trusses and stars, against 4.7 to
/// 6.8 in chains (`docs/limits.md`).
const GENERAL: usize = 16;

/// Advances the state by one frame.
pub(super) fn frame<const D: usize>(frame: &mut Frame<'_>, state: &mut State) -> Result<StepReport, StepError> {
    let (system, length) = (frame.system, frame.length);
    if !system.contacts.is_empty() {
        // Only the embedded pairs locate events, so a system with contacts always runs DOP853.
        let report = pair_frame::frame::<D>(&dop853::DOP853, frame, state)?;
        return Ok(StepReport { integrator: Integrator::Dop853, ..report });
    }
    let (start, limit) = (state.t, most_substeps(system, frame.settings));
    let resting = state.carry.as_ref().map_or(0, |carry| carry.resting);
    let mut report = StepReport::default();
    if resting == 0 && limit > 0 {
        match pair_frame::carry_on::<D>(&dop853::DOP853, frame, state, limit) {
            Ok((report, true)) => return Ok(StepReport { integrator: Integrator::Dop853, ..report }),
            Ok((partly, false)) => report = partly,
            // Constraints that substeps cannot meet may be met at the end of a step.
            Err(error) if error.is_unmet() => {}
            Err(error) => return Err(error),
        }
        state.carry = None;
    }
    let rest = length - (state.t - start);
    let ending = implicit::frame::<D>(&bdf2::BDF2, &mut frame.over(rest), state)?;
    report.absorb(ending);
    report.warn(Warning::TooStiff { substeps: limit });
    report.integrator = Integrator::Bdf2;
    // The two parts add up to the frame only up to rounding.
    state.t = start + length;
    if let Some(carry) = &mut state.carry {
        carry.resting = if resting == 0 { REST } else { resting - 1 };
    }
    Ok(report)
}

/// The number of substeps that the work of a frame allows; 0 where it allows none.
fn most_substeps(system: &System, settings: &Settings) -> usize {
    let a_row = if system.chains.is_some() { 1 } else { GENERAL };
    let substep = dop853::DOP853.stages() * a_row * system.row_count().max(1);
    (settings.frame_work / substep).min(settings.max_substeps)
}
