//! Auto: DOP853 where its substeps can follow the motion, Radau IIA where damping or stiffness bounds them, BDF2 where
//! neither fits into the work allowed for a frame.
//!
//! An explicit method must follow the fastest rate of a system, whether anything moves at that rate or not. DOP853 is
//! stable for substeps of up to about 6/rate. The rates of dampers and springs are known before a frame: if they would
//! bound the substeps to many in the frame, DOP853 is tried for a few only. Where these do not do, the rest of the
//! frame belongs to Radau IIA, as long as it takes a quarter of the substeps of DOP853 or less, in open chains a 64th;
//! so a motion that is really as fast as its rates goes back to DOP853. Radau IIA then stays while the rates are high.
//!
//! A chain with beads m and links L under tension T swings at up to ω = 2√(T/(m L)). ω grows with the root of the load,
//! and so does the number of substeps in a frame. A frame in which both methods run out of work is finished by BDF2,
//! and BDF2 stays for some frames before the others are tried again. The work is counted in row solves, not in seconds,
//! and the choice is part of the state: the same input gives the same bits.
//!
//! BDF2 loses energy, and the fast oscillations that h cannot show; rods hold all the same. The report names the
//! integrator that advanced the frame.

use super::adaptive::{control, dop853, pair_frame};
use super::frame::Frame;
use super::implicit::{self, bdf2};
use super::radau;
use crate::error::StepError;
use crate::point::Motion;
use crate::report::{StepReport, Warning};
use crate::settings::{Integrator, Settings};
use crate::state::{Choice, State};
use crate::system::System;

/// Frames for which a choice stays before DOP853 is tried again: half a second at 60 frames a second, with a thirtieth
/// of the work lost on trying.
const REST: u32 = 30;

/// Cost of a row on the general path, in rows of `chains/`: 79 to 86 ns a stage in trusses and stars, against 4.7 to
/// 6.8 in chains (`docs/limits.md`).
const GENERAL: usize = 16;

/// h times the rate of a decay or of an oscillation at which DOP853 is about to be unstable.
const STABLE: f64 = 6.0;

/// Substeps of DOP853 in a frame above which a system counts as stiff, and the number that is tried all the same: rates
/// at which nothing moves do not bound the substeps.
const FEW: usize = 32;

/// Substeps of DOP853 that cost as much as one of Radau IIA, at least: three systems of equations are solved some three
/// times, and two factors are made. Radau IIA has no path of its own for open chains, whose rows cost DOP853 a
/// sixteenth ([`GENERAL`]).
const AS_MUCH: usize = 4;

/// Least number of substeps with which Radau IIA is tried where it is the work that runs out.
const WORTH_A_TRY: usize = 16;

/// Advances the state by one frame.
pub(super) fn frame<const D: usize>(frame: &mut Frame<'_>, state: &mut State) -> Result<StepReport, StepError> {
    let (system, length) = (frame.system, frame.length);
    if !system.contacts.is_empty() {
        // Only the embedded pairs locate events, so a system with contacts always runs DOP853.
        let report = pair_frame::frame::<D>(&dop853::DOP853, frame, state)?;
        return Ok(StepReport { integrator: Integrator::Dop853, ..report });
    }
    let (start, limit) = (state.t, most_substeps(system, frame.settings));
    let (wanted, choice) = (wanted_substeps::<D>(system, state, length), state.carry.as_ref().and_then(|c| c.choice));
    let is_stiff = wanted > FEW as f64;
    let chosen = choice.map(|choice| choice.integrator);
    // As many substeps of Radau IIA as pay.
    let as_much = if system.chains.is_some() { AS_MUCH * GENERAL } else { AS_MUCH };
    let most = limit / as_much;
    let paying = if is_stiff { most.min((wanted / as_much as f64) as usize) } else { most };
    let explicit = |limit: usize| (Integrator::Dop853, limit);
    let by_radau = (Integrator::Radau5, if is_stiff || most >= WORTH_A_TRY { paying } else { 0 });
    let plan = match chosen {
        Some(Integrator::Bdf2) => vec![],
        Some(Integrator::Radau5) => vec![by_radau, explicit(limit)],
        Some(_) => vec![explicit(limit), by_radau],
        None if is_stiff => vec![explicit(limit.min(FEW)), by_radau, explicit(limit)],
        None => vec![explicit(limit), by_radau],
    };
    let mut report = StepReport::default();
    for &(integrator, limit) in &plan {
        if limit == 0 {
            continue;
        }
        let mut rest = frame.over(length - (state.t - start));
        let outcome = match integrator {
            Integrator::Radau5 => radau::carry_on::<D>(&mut rest, state, limit),
            _ => pair_frame::carry_on::<D>(&dop853::DOP853, &mut rest, state, limit),
        };
        match outcome {
            Ok((part, is_whole)) => {
                report.absorb(part);
                if is_whole {
                    report.integrator = integrator;
                    // The parts add up to the frame only up to rounding.
                    state.t = start + length;
                    let is_stiff = is_stiff && (integrator == Integrator::Radau5 || limit > FEW);
                    let next = chosen_next(integrator, choice, is_stiff);
                    state.carry.iter_mut().for_each(|carry| carry.choice = next);
                    return Ok(report);
                }
            }
            // Constraints that substeps cannot meet may be met at the end of a step.
            Err(error) if error.is_unmet() || matches!(error, StepError::TooCoupled { .. }) => {}
            Err(error) => return Err(error),
        }
        state.carry = None;
    }
    let rest = length - (state.t - start);
    let ending = implicit::frame::<D>(&bdf2::BDF2, &mut frame.over(rest), state)?;
    report.absorb(ending);
    report.warn(Warning::TooStiff { substeps: limit });
    report.integrator = Integrator::Bdf2;
    state.t = start + length;
    if let Some(carry) = &mut state.carry {
        let next = choice.filter(|choice| choice.integrator == Integrator::Bdf2);
        let frames = next.map_or(REST, |choice| choice.frames.saturating_sub(1));
        carry.choice = (frames > 0).then_some(Choice { integrator: Integrator::Bdf2, frames });
    }
    Ok(report)
}

/// What the next frames begin with after a whole frame of DOP853 or Radau IIA. `is_stiff`: high rates, and more than a
/// few substeps.
fn chosen_next(integrator: Integrator, before: Option<Choice>, is_stiff: bool) -> Option<Choice> {
    let frames = match before {
        Some(Choice { integrator: same, frames }) if same == integrator => frames.saturating_sub(1),
        _ => REST,
    };
    // Radau IIA stays while the rates are high. DOP853 stays for a time where Radau IIA was no better.
    let frames = if integrator == Integrator::Radau5 && is_stiff { REST } else { frames };
    let stays = frames > 0 && (is_stiff || integrator == Integrator::Radau5);
    stays.then_some(Choice { integrator, frames })
}

/// The substeps of DOP853 to which the rates of the forces bound a frame of this length [s].
fn wanted_substeps<const D: usize>(system: &System, state: &State, length: f64) -> f64 {
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    let [oscillation, decay] = control::rates_of_forces(system, motion);
    length * oscillation.max(decay) / STABLE
}

/// The number of substeps that the work of a frame allows; 0 where it allows none.
fn most_substeps(system: &System, settings: &Settings) -> usize {
    let a_row = if system.chains.is_some() { 1 } else { GENERAL };
    let substep = dop853::DOP853.stages() * a_row * system.all_row_count().max(1);
    (settings.frame_work / substep).min(settings.max_substeps)
}
