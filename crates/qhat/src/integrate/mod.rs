//! From one state to the next.
//!
//! | folder | methods |
//! |---|---|
//! | `fixed/` | steps of exactly h: Euler, semi-implicit Euler, RK4 |
//! | `adaptive/` | substeps by an error estimate: the frame loop, and the pairs DOPRI5 and DOP853 |
//! | `implicit/` | steps solved at their end: backward Euler, BDF2 |
//! | `radau/` | substeps solved at their end, by an error estimate: Radau IIA of order 5 |
//! | `events/` | the pairs on a system with contacts: substeps that end at events |
//!
//! `rattle.rs` is RATTLE in the frame loop, `auto.rs` chooses between DOP853, Radau IIA and BDF2, `projection.rs`
//! makes a start consistent. `runge_kutta/` and `field.rs` are shared by all Runge–Kutta methods.
//!
//! To add an integrator: write one file here, name it in [`crate::Integrator`] with its order, and call it in
//! `step_for`.

mod adaptive;
mod auto;
mod dead_centre;
mod edges;
mod events;
mod failure;
mod field;
mod fixed;
mod frame;
mod implicit;
mod projection;
mod radau;
mod rattle;
mod reading;
mod runge_kutta;
mod watch;
mod workspace;

pub use workspace::Workspace;

use crate::constraint::{Holds, NamedConstraint};
use crate::contact::{close, deepest};
use crate::energy;
use crate::error::StepError;
use crate::point::Motion;
use crate::report::{Projection, StepReport};
use crate::settings::{Integrator, Settings, SettingsError};
use crate::space::in_dimension;
use crate::state::State;
use crate::system::System;
use adaptive::{dop853, dopri5, pair_frame};
use dead_centre::undecided;
use failure::{at_an_edge, without_length};
use frame::Frame;

/// Advances a state by one step of h (a fixed-step integrator) or one frame of h (an adaptive one).
///
/// # Errors
/// See [`StepError`]. The state is then the last good one: where the step began, or for an adaptive integrator the
/// end of its last substep.
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
    length: f64,
    workspace: &mut Workspace,
) -> Result<StepReport, StepError> {
    settings.check()?;
    check_finds_events(system, settings)?;
    check_length(length)?;
    if state.rank_in(system.all_row_count()).is_none() {
        state.rank = None;
    }
    workspace.follow(system);
    workspace.begin_watch(system, settings);
    let frame = &mut Frame { system, settings, workspace, length };
    let report: StepReport = in_dimension!(system.dimension, D => match settings.integrator {
        Integrator::Euler => fixed::run::<D>(frame, state, fixed::euler::step::<D>),
        Integrator::SymplecticEuler => fixed::run::<D>(frame, state, fixed::symplectic_euler::step::<D>),
        Integrator::Rk4 => fixed::run::<D>(frame, state, fixed::rk4::step::<D>),
        Integrator::Auto => auto::frame::<D>(frame, state),
        Integrator::Rattle => rattle::frame::<D>(frame, state),
        Integrator::Dopri5 => pair_frame::frame::<D>(&dopri5::DOPRI5, frame, state),
        Integrator::Dop853 => pair_frame::frame::<D>(&dop853::DOP853, frame, state),
        Integrator::Radau5 => radau::frame::<D>(frame, state),
        Integrator::Implicit => implicit::frame::<D>(&implicit::backward_euler::BACKWARD_EULER, frame, state),
        Integrator::Bdf2 => implicit::frame::<D>(&implicit::bdf2::BDF2, frame, state),
    })?;
    if !report.energy.total().is_finite() {
        check_energy(system, state)?;
    }
    // Integrators that may leave a frame to another one report which of them advanced it.
    let integrator = match settings.integrator {
        Integrator::Auto | Integrator::Rattle => report.integrator,
        own => own,
    };
    Ok(StepReport { integrator, max_tension: workspace.largest_tension(), ..report })
}

/// Refuses a frame that would never end, or end before it began.
fn check_length(length: f64) -> Result<(), SettingsError> {
    if length.is_finite() && length > 0.0 {
        Ok(())
    } else {
        Err(SettingsError::OutOfRange { name: "frame", value: length, range: "finite and positive" })
    }
}

/// Refuses an integrator that locates no events, for a system that has contacts or breakable constraints.
pub(crate) fn check_finds_events(system: &System, settings: &Settings) -> Result<(), StepError> {
    let first = system.contacts.list.first().map(|contact| contact.constraint);
    match first.or(system.contacts.breakables.first().map(|breakable| breakable.constraint)) {
        Some(place) if !settings.integrator.finds_events() => {
            let constraint = system.constraints[place].name.clone();
            Err(StepError::NoEvents { integrator: settings.integrator, constraint })
        }
        _ => Ok(()),
    }
}

/// Whether a simulation can start from a state as it is: the integrator locates the events that the system has, kinetic
/// and potential energy are finite, every stretch and arm of a constraint has a length, and no contact or limit is
/// violated beyond the tolerance of a closed one.
///
/// # Errors
/// [`StepError::NoEvents`]; [`StepError::EnergyNotFinite`]; [`StepError::NoGradient`], of the first stretch or arm
/// without length; [`StepError::Penetrates`], of the constraint that is violated most.
pub fn check_start(system: &System, state: &State, settings: &Settings) -> Result<(), StepError> {
    check_finds_events(system, settings)?;
    check_energy(system, state)?;
    let lost = in_dimension!(system.dimension, D => without_length::<D>(system, state.t, &state.q));
    if let Some(error) = lost {
        return Err(error);
    }
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

/// Moves a state to the nearest one, in the mass metric, with C = 0 and Ċ = 0 in which no contact or limit is violated,
/// and closes taut ropes and contacts at rest. A consistent state does not move. A velocity with which a touching
/// contact approaches stays: the first step resolves it as an impact, with the restitution of the contact.
///
/// # Errors
/// [`StepError::NotSatisfied`] and [`StepError::DriveBlocked`] where no such positions are found,
/// [`StepError::RateNotSatisfied`] where no such velocities exist, [`StepError::CurveEnds`] beyond the end of a curve,
/// and [`StepError::Undecided`] at a dead centre. The state stays as it was.
pub fn project(
    system: &System,
    state: &mut State,
    settings: &Settings,
    workspace: &mut Workspace,
) -> Result<Projection, StepError> {
    settings.check()?;
    workspace.follow(system);
    workspace.equation.solver.memory.forget();
    in_dimension!(system.dimension, D => {
        let before = state.clone();
        let projection = projection::project::<D>(system, state, settings, workspace)?;
        // A curve has an end, and from a dead centre more than one motion follows a drive.
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        if let Some(error) = at_an_edge(system, state, motion).or_else(|| undecided::<D>(system, state, workspace)) {
            *state = before;
            return Err(error);
        }
        if !system.contacts.list.is_empty() {
            close::<D>(system, state, settings, &mut workspace.equation);
        }
        Ok(projection)
    })
}

/// The nearest state with C = 0 and Ċ = 0, for what is measured there: a motion need not be possible from it.
///
/// # Errors
/// As [`project`], where no such positions or velocities are found.
pub(crate) fn consistent(system: &System, state: &State, settings: &Settings) -> Result<State, StepError> {
    let (mut state, mut workspace) = (state.clone(), Workspace::new(system));
    in_dimension!(system.dimension, D => {
        projection::project::<D>(system, &mut state, settings, &mut workspace)?;
        Ok(state)
    })
}

/// Refuses a state whose kinetic or potential energy is not finite, with the name of a particle.
pub(crate) fn check_energy(system: &System, state: &State) -> Result<(), StepError> {
    in_dimension!(system.dimension, D => {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        energy::check_finite(system, motion, &state.modes.broken, state.t)
    })
}

/// `Ok` if every coordinate and velocity is finite; t is that of the last good state.
fn check_finite<const D: usize>(system: &System, t: f64, q: &[f64], qd: &[f64]) -> Result<(), StepError> {
    let lost = q.iter().zip(qd).position(|(x, v)| !x.is_finite() || !v.is_finite());
    match lost {
        Some(k) => Err(StepError::NotFinite { time: t, particle: system.particle_names[k / D].clone() }),
        None => Ok(()),
    }
}
