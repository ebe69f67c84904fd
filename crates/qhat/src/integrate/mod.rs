//! From one state to the next: one method a file.
//!
//! To add an integrator: write one file here, name it in [`crate::Integrator`] with its order, and call it in `step_for`.

mod adaptive;
mod auto;
mod bdf2;
mod control;
mod dop853;
mod dopri5;
mod end_of_step;
mod euler;
mod events;
mod field;
mod implicit;
mod pair;
mod projection;
mod rattle;
mod rk4;
mod runge_kutta;
mod symplectic_euler;

use crate::constraint::Holds;
use crate::error::StepError;
use crate::lanes::Lanes;
use crate::measure::{self, Drift};
use crate::multiplier::{Equation, Multipliers};
use crate::point::Motion;
use crate::report::{Projection, StepReport};
use crate::settings::{Feedback, Integrator, Settings};
use crate::state::State;
use crate::switching::{close, deepest};
use crate::system::{NamedConstraint, System, in_dimension};

/// A constraint off by this many times its own size is beyond recognition: what follows would only be larger numbers.
const DIVERGED: f64 = 1e3;

/// Arrays that steps write in, made once for a system. Holds nothing that changes a result.
#[derive(Clone, Debug)]
pub struct Workspace {
    equation: Equation,
    /// The state being tried.
    q: Vec<f64>,
    qd: Vec<f64>,
    /// The q, with t behind it, whose A the solver holds factored without ε; empty if that is not known.
    factored_at: Vec<f64>,
    delta: Vec<f64>,
    stages: runge_kutta::Stages,
    /// Made when a method first goes in lanes.
    lanes: Option<Lanes>,
    rattle: rattle::Scratch,
    end_of_step: Option<Box<end_of_step::Scratch>>,
}

impl Workspace {
    /// Arrays for one system.
    pub fn new(system: &System) -> Self {
        let coordinates = system.coordinate_count();
        Workspace {
            equation: Equation::new(system),
            q: vec![0.0; coordinates],
            qd: vec![0.0; coordinates],
            factored_at: Vec::new(),
            delta: vec![0.0; system.row_count()],
            stages: runge_kutta::Stages::default(),
            lanes: None,
            rattle: rattle::Scratch::new(system),
            end_of_step: None,
        }
    }

    pub(crate) fn equation(&self) -> &Equation {
        &self.equation
    }

    /// Solves the equation at a state; a factor of A that is there already is kept.
    pub(crate) fn solve<const D: usize>(&mut self, system: &System, state: &State, feedback: &Feedback) -> &Equation {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let is_factored = feedback.diagonal_drag == 0.0 && self.is_factored_at(state);
        if !is_factored {
            self.equation.solver.stays_deficient = false;
        }
        self.set_modes(system, state);
        self.equation.solve(system, motion, feedback, is_factored, Multipliers::Least);
        self.factored_at.clear();
        if feedback.diagonal_drag == 0.0 {
            self.note_factored(state);
        }
        &self.equation
    }

    /// From now on those rows take part that do in the state.
    pub(crate) fn set_modes(&mut self, system: &System, state: &State) {
        if !system.switches.is_empty() {
            self.equation.set_modes(system, &state.modes);
        }
    }

    /// Whether the factor at hand is that of A at the state.
    fn is_factored_at(&self, state: &State) -> bool {
        self.factored_at.split_last() == Some((&state.t, &state.q[..]))
    }

    /// The factor at hand is that of A at the state.
    fn note_factored(&mut self, state: &State) {
        self.factored_at.clone_from(&state.q);
        self.factored_at.push(state.t);
    }
}

/// Carries a state over one step of h (a fixed-step integrator) or one frame of h (an adaptive one).
///
/// # Errors
/// See [`StepError`]. The state is then the last good one: where the step began, or for an adaptive integrator the end of
/// its last substep.
pub fn step(
    system: &System,
    state: &mut State,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    step_for(system, state, settings, settings.h, workspace)
}

/// The same over a frame of another length [s], for adaptive integrators.
pub(crate) fn step_for(
    system: &System,
    state: &mut State,
    settings: &Settings,
    frame: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    settings.check()?;
    check_switches(system, settings)?;
    let report: StepReport = in_dimension!(system.dimension, D => match settings.integrator {
        Integrator::Euler => fixed::<D>(system, state, frame, workspace, euler::step::<D>),
        Integrator::SymplecticEuler => fixed::<D>(system, state, frame, workspace, symplectic_euler::step::<D>),
        Integrator::Rk4 => fixed::<D>(system, state, frame, workspace, rk4::step::<D>),
        Integrator::Auto => auto::frame::<D>(system, state, settings, frame, workspace),
        Integrator::Rattle => rattle::frame::<D>(system, state, settings, frame, workspace),
        Integrator::Dopri5 => pair::frame::<D>(&dopri5::DOPRI5, system, state, settings, frame, workspace),
        Integrator::Dop853 => pair::frame::<D>(&dop853::DOP853, system, state, settings, frame, workspace),
        Integrator::Implicit => {
            end_of_step::frame::<D>(&implicit::IMPLICIT, system, state, settings, frame, workspace)
        }
        Integrator::Bdf2 => end_of_step::frame::<D>(&bdf2::BDF2, system, state, settings, frame, workspace),
    })?;
    // Those that may leave a frame to another say themselves who carried it.
    let integrator = match settings.integrator {
        Integrator::Auto | Integrator::Rattle => report.integrator,
        own => own,
    };
    Ok(StepReport { integrator, ..report })
}

/// Refuses an integrator that cannot find events, where there are some to find.
pub(crate) fn check_switches(system: &System, settings: &Settings) -> Result<(), StepError> {
    let first = system.switches.contacts.first().map(|contact| contact.constraint);
    match first.or(system.switches.breakables.first().map(|breakable| breakable.constraint)) {
        Some(place) if !settings.integrator.finds_events() => {
            let constraint = system.constraints[place].name.clone();
            Err(StepError::NoEvents { integrator: settings.integrator, constraint })
        }
        _ => Ok(()),
    }
}

/// Whether a simulation can start from a state as it is: that the integrator finds the events that there are, and that no contact or
/// limit is violated by more than it may be off where it holds.
///
/// # Errors
/// [`StepError::NoEvents`]; [`StepError::Penetrates`], of the constraint that is violated most.
pub fn check_start(system: &System, state: &State, settings: &Settings) -> Result<(), StepError> {
    check_switches(system, settings)?;
    let violation = in_dimension!(system.dimension, D => deepest::<D>(system, state, settings.constraint_tolerance));
    match violation {
        Some((place, depth)) => {
            let NamedConstraint { name, constraint, .. } = &system.constraints[place];
            let particles = constraint.particles().into_iter().map(|id| system.particle_names[id.0].clone());
            Err(StepError::Penetrates {
                time: state.t,
                constraint: name.clone(),
                particles: particles.collect(),
                depth,
            })
        }
        None => Ok(()),
    }
}

/// Moves a state to the nearest one with C = 0 and Ċ = 0, in the mass metric. Nothing moves if it is consistent already. What is taut or
/// lies on something is closed.
///
/// # Errors
/// [`StepError::NotSatisfied`] where no such positions are found; the state stays as it was.
pub fn project(
    system: &System,
    state: &mut State,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Result<Projection, StepError> {
    settings.check()?;
    workspace.factored_at.clear();
    in_dimension!(system.dimension, D => {
        let projection = projection::project::<D>(system, state, settings, workspace)?;
        if !system.switches.contacts.is_empty() {
            close::<D>(system, state, settings, &mut workspace.equation);
        }
        Ok(projection)
    })
}

/// What a fixed-step method says of the step it wrote to the workspace [J].
#[derive(Clone, Copy, Debug, Default)]
struct StepWork {
    dissipation: f64,
    stabilization: f64,
    drives: f64,
}

type FixedStep = fn(&System, &State, f64, &mut Workspace) -> StepWork;

/// One step of a method without substeps: try, check, keep.
fn fixed<const D: usize>(
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
        energy: measure::energy(system, state),
        warnings,
        ..StepReport::default()
    })
}

/// Refuses a tried state that is not finite or has diverged; t is that of the last good state, h the step from there.
fn examine<const D: usize>(system: &System, t: f64, h: f64, workspace: &mut Workspace) -> Result<Drift, StepError> {
    check_finite::<D>(system, t, &workspace.q, &workspace.qd)?;
    workspace.equation.constrain(system, Motion::<D> { q: &workspace.q, qd: &workspace.qd, t: t + h });
    let drift = measure::drift::<D>(system, &workspace.equation, &workspace.q);
    if drift.relative > DIVERGED {
        let row = system.row_names[drift.worst_row].clone();
        return Err(StepError::Diverged { time: t, row, relative: drift.relative });
    }
    Ok(drift)
}

fn check_finite<const D: usize>(system: &System, t: f64, q: &[f64], qd: &[f64]) -> Result<(), StepError> {
    let lost = q.iter().zip(qd).position(|(x, v)| !x.is_finite() || !v.is_finite());
    match lost {
        Some(k) => Err(StepError::NotFinite { time: t, particle: system.particle_names[k / D].clone() }),
        None => Ok(()),
    }
}
