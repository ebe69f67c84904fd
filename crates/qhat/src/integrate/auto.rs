//! The choice that needs no thought: DOP853 where a frame can be followed with the work allowed, BDF2 where it cannot.
//!
//! A chain with beads m and links L under tension T swings at up to ω = 2√(T/(m L)), and an explicit method must follow it with
//! h ω of about 5: under a load of a million beads a frame took 230 substeps, and ω grows with its root. So a frame whose
//! substeps run out of work is finished at the end of the step, and BDF2 stays for some frames before the other is tried again. The work is
//! counted in row solves, not in seconds: the same input gives the same bits.
//!
//! What is lost with BDF2 is energy, and the fast oscillations that h cannot show; rods hold all the same. The report says who
//! carried the frame.

use super::Workspace;
use super::adaptive::{self, dop853, pair};
use super::implicit::{self, bdf2};
use crate::error::StepError;
use crate::report::{StepReport, Warning};
use crate::settings::{Integrator, Settings};
use crate::state::State;
use crate::system::System;

/// Frames that BDF2 keeps before the substeps are tried again: half a second of a page, a thirtieth of the work lost on trying.
const REST: u32 = 30;

/// What a row costs outside the lanes, in rows of the lanes: 65 to 100 ns a solve against 4 to 6.
const GENERAL: usize = 16;

pub(super) fn frame<const D: usize>(
    system: &System,
    state: &mut State,
    settings: &Settings,
    length: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    adaptive::check_length(length)?;
    if !system.contacts.is_empty() {
        // Nobody else finds events.
        let report = pair::frame::<D>(&dop853::DOP853, system, state, settings, length, workspace)?;
        return Ok(StepReport { integrator: Integrator::Dop853, ..report });
    }
    let (start, limit) = (state.t, most_substeps(system, settings));
    let resting = state.carry.as_ref().map_or(0, |carry| carry.resting);
    let mut report = StepReport::default();
    if resting == 0 && limit > 0 {
        match pair::carry_on::<D>(&dop853::DOP853, system, state, settings, length, limit, workspace) {
            Ok((report, true)) => return Ok(StepReport { integrator: Integrator::Dop853, ..report }),
            Ok((partly, false)) => report = partly,
            // What it cannot satisfy may be met at the end of a step.
            Err(StepError::NotSatisfied { .. }) => {}
            Err(error) => return Err(error),
        }
        state.carry = None;
    }
    let rest = length - (state.t - start);
    let ending = implicit::frame::<D>(&bdf2::BDF2, system, state, settings, rest, workspace)?;
    report.absorb(ending);
    report.warn(Warning::TooStiff { substeps: limit });
    report.integrator = Integrator::Bdf2;
    // The two parts of the frame add up to it but for rounding.
    state.t = start + length;
    if let Some(carry) = &mut state.carry {
        carry.resting = if resting == 0 { REST } else { resting - 1 };
    }
    Ok(report)
}

/// How many substeps the work of a frame allows; 0 where it does not allow any.
fn most_substeps(system: &System, settings: &Settings) -> usize {
    let a_row = if system.chains.is_some() { 1 } else { GENERAL };
    let substep = dop853::DOP853.stages() * a_row * system.row_count().max(1);
    (settings.frame_work / substep).min(settings.max_substeps)
}
