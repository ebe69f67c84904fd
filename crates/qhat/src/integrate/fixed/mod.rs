//! Methods that take steps of exactly h: try, check, keep.

pub(crate) mod euler;
pub(crate) mod rk4;
pub(crate) mod symplectic_euler;

use super::check_finite;
use super::failure::at_an_edge;
use super::frame::Frame;
use crate::drift::{Drift, drift};
use crate::energy;
use crate::error::StepError;
use crate::point::Motion;
use crate::report::StepReport;
use crate::state::State;

/// Residual of a constraint, relative to its own size, above which a step has diverged: what follows would only be
/// larger numbers.
const DIVERGED: f64 = 1e3;

/// The work of a step that its method wrote to the workspace [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepWork {
    pub(crate) dissipation: f64,
    pub(crate) stabilization: f64,
    pub(crate) drives: f64,
}

/// Writes one step of the frame's length to the workspace.
pub(crate) type FixedStep = fn(&mut Frame<'_>, &State) -> StepWork;

/// One step of a method without substeps.
pub(crate) fn run<const D: usize>(
    frame: &mut Frame<'_>,
    state: &mut State,
    method: FixedStep,
) -> Result<StepReport, StepError> {
    let factorizations = frame.factorizations();
    let work = method(frame, state);
    let warnings = frame.workspace.equation.warnings(frame.system);
    frame.workspace.equation.solver.memory.forget();
    let drift = examine::<D>(frame, state.t)?;
    let tried = Motion::<D> { q: &frame.workspace.q, qd: &frame.workspace.qd, t: state.t + frame.length };
    if let Some(error) = at_an_edge(frame.system, state, tried) {
        return Err(error);
    }
    std::mem::swap(&mut state.q, &mut frame.workspace.q);
    std::mem::swap(&mut state.qd, &mut frame.workspace.qd);
    state.t += frame.length;
    let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
    frame.workspace.equation.follow_feet(frame.system, motion, &mut state.feet);
    state.work.dissipation += work.dissipation;
    state.work.stabilization += work.stabilization;
    state.work.drives += work.drives;
    state.carry = None;
    state.rank.clone_from(&frame.workspace.equation.rank);
    if let Some(watch) = &mut frame.workspace.watch {
        watch.note(frame.system, state);
    }
    let mut report = StepReport {
        factorizations: frame.factorizations() - factorizations,
        smallest_substep: frame.length,
        energy: energy::energy(frame.system, state),
        warnings,
        ..StepReport::default()
    };
    report.book(frame.length, 0, &drift);
    Ok(report)
}

/// Refuses a tried state that is not finite or has diverged; t is that of the last good state.
fn examine<const D: usize>(frame: &mut Frame<'_>, t: f64) -> Result<Drift, StepError> {
    let Frame { system, workspace, length: h, .. } = frame;
    check_finite::<D>(system, t, &workspace.q, &workspace.qd)?;
    let motion = Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: t + *h };
    // Velocities overflow in T long before they overflow themselves.
    energy::check_finite(system, motion, &[], t).map_err(|error| match error {
        StepError::EnergyNotFinite { time, particle, .. } => StepError::NotFinite { time, particle },
        other => other,
    })?;
    workspace.equation.constrain(system, motion);
    let drift = drift::<D>(system, &workspace.equation.rows, &workspace.equation.inactive, &workspace.q);
    if drift.relative > DIVERGED {
        let row = system.row_names[drift.worst_row].clone();
        return Err(StepError::Diverged { time: t, row, relative: drift.relative });
    }
    Ok(drift)
}
