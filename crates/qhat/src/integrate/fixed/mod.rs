//! Methods that take steps of exactly h: try, check, keep.

pub(crate) mod euler;
pub(crate) mod rk4;
pub(crate) mod symplectic_euler;

use super::{Workspace, check_finite};
use crate::drift::{Drift, drift};
use crate::energy;
use crate::error::StepError;
use crate::point::Motion;
use crate::report::StepReport;
use crate::state::State;
use crate::system::System;

/// A constraint off by this many times its own size is beyond recognition: what follows would only be larger numbers.
const DIVERGED: f64 = 1e3;

/// What a fixed-step method says of the step it wrote to the workspace [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StepWork {
    pub(crate) dissipation: f64,
    pub(crate) stabilization: f64,
    pub(crate) drives: f64,
}

pub(crate) type FixedStep = fn(&System, &State, f64, &mut Workspace) -> StepWork;

/// One step of a method without substeps: try, check, keep.
pub(crate) fn run<const D: usize>(
    system: &System,
    state: &mut State,
    h: f64,
    workspace: &mut Workspace,
    method: FixedStep,
) -> Result<StepReport, StepError> {
    let factorizations = workspace.equation.solver.factorizations;
    let work = method(system, state, h, workspace);
    let warnings = workspace.equation.warnings(system);
    workspace.factored_at.clear();
    let drift = examine::<D>(system, state.t, h, workspace)?;
    std::mem::swap(&mut state.q, &mut workspace.q);
    std::mem::swap(&mut state.qd, &mut workspace.qd);
    state.t += h;
    state.work.dissipation += work.dissipation;
    state.work.stabilization += work.stabilization;
    state.work.drives += work.drives;
    state.carry = None;
    Ok(StepReport {
        substeps: 1,
        factorizations: workspace.equation.solver.factorizations - factorizations,
        smallest_substep: h,
        max_residual: drift.residual,
        max_residual_rate: drift.residual_rate,
        max_relative_length_error: drift.relative_length,
        energy: energy::energy(system, state),
        warnings,
        ..StepReport::default()
    })
}

/// Refuses a tried state that is not finite or has diverged; t is that of the last good state, h the step from there.
fn examine<const D: usize>(system: &System, t: f64, h: f64, workspace: &mut Workspace) -> Result<Drift, StepError> {
    check_finite::<D>(system, t, &workspace.q, &workspace.qd)?;
    workspace.equation.constrain(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: t + h });
    let drift = drift::<D>(system, &workspace.equation.rows, &workspace.equation.inactive, &workspace.q);
    if drift.relative > DIVERGED {
        let row = system.row_names[drift.worst_row].clone();
        return Err(StepError::Diverged { time: t, row, relative: drift.relative });
    }
    Ok(drift)
}
