//! One hostile scene: it is read, checked, begun and run for a few frames, and the first fault is told.

use super::Input;
use crate::dense::largest;
use qhat::{Integrator, Settings, Simulation, StepError, Warning};
use qhat_scene::{Scene, load_bytes};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// The most rows of a scene that is run. Larger scenes are read and built alone, because a frame takes long.
const MOST_ROWS: usize = 600;
/// The most particles of a scene that is run.
const MOST_PARTICLES: usize = 1000;
/// The most substeps, Newton iterations and row solves of a frame, in place of larger numbers of the scene.
const LIMITS: (usize, usize, usize) = (1000, 200, 200_000);
/// The longest time of one scene; with the limits above, scenes take milliseconds.
const LONGEST: Duration = Duration::from_secs(10);
/// The frames that are run.
const FRAMES: usize = 3;
/// The energy that may be missing without a warning, relative to the largest kinetic energy \[1\]. qhat warns of a
/// hundredth in one step, so three frames without a warning keep it below 0.03.
const ENERGY: f64 = 0.1;

/// A fault, an answer of qhat that no scene may get: a word for the kind, and the particulars.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The kind of fault.
    pub kind: &'static str,
    /// The particulars: a message, a number, a place.
    pub seen: String,
}

fn fault(kind: &'static str, seen: impl Into<String>) -> Result<(), Fault> {
    Err(Fault { kind, seen: seen.into() })
}

/// Tries an input.
///
/// # Errors
/// The first fault.
pub fn attempt(input: &Input) -> Result<(), Fault> {
    let start = Instant::now();
    let ended = catch_unwind(AssertUnwindSafe(|| run(input)));
    match ended {
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            fault("panic", text.unwrap_or_default())
        }
        Ok(Ok(())) if start.elapsed() > LONGEST => fault("slow", format!("{:?}", start.elapsed())),
        Ok(outcome) => outcome,
    }
}

fn run(input: &Input) -> Result<(), Fault> {
    let scene = match load_bytes(&input.bytes, "hostile", input.format) {
        Ok(scene) => scene,
        Err(errors) => {
            let text = errors.to_string();
            if errors.errors.is_empty() || errors.errors.iter().any(|error| error.message.is_empty()) {
                return fault("no words", text);
            }
            let ends = errors.errors.iter().any(|error| error.span.end > input.bytes.len());
            return if ends { fault("place", text) } else { Ok(()) };
        }
    };
    if scene.system.row_count() > MOST_ROWS || scene.system.particle_count() > MOST_PARTICLES {
        return Ok(());
    }
    let given = scene.settings;
    let settings = Settings {
        max_substeps: given.max_substeps.min(LIMITS.0),
        frame_budget: given.frame_budget.min(LIMITS.1),
        frame_work: given.frame_work.min(LIMITS.2),
        ..given
    };
    match start(&scene, settings)? {
        Some(simulation) => frames(simulation),
        None => Ok(()),
    }
}

fn begin(scene: &Scene, settings: Settings) -> Result<Simulation, StepError> {
    Simulation::new(scene.system.clone(), scene.state.clone(), settings)
}

/// The start of a run, and whether `check`, which starts with dop853, agrees with it; none where both refuse.
fn start(scene: &Scene, settings: Settings) -> Result<Option<Simulation>, Fault> {
    let started = begin(scene, settings);
    if settings.integrator.projects() {
        let checked = begin(scene, Settings { integrator: Integrator::Dop853, ..settings });
        let cannot = |outcome: &Result<Simulation, StepError>| matches!(outcome, Err(StepError::NoEvents { .. }));
        if started.is_ok() != checked.is_ok() && !cannot(&started) {
            let [run, check] = [&started, &checked].map(|outcome| outcome.as_ref().err().map(ToString::to_string));
            fault("check and run", format!("run: {run:?}, check: {check:?}"))?;
        }
    }
    match started {
        Ok(simulation) => Ok(Some(simulation)),
        Err(error) if error.to_string().is_empty() => fault("no words", format!("{error:?}")).map(|()| None),
        Err(_) => Ok(None),
    }
}

fn frames(mut simulation: Simulation) -> Result<(), Fault> {
    let settings = *simulation.settings();
    let (mut warned, mut moved) = (false, false);
    for frame in 0..FRAMES {
        let speed = largest(simulation.state().velocities());
        let report = match simulation.step() {
            Ok(report) => report,
            Err(error) if error.to_string().is_empty() => return fault("no words", format!("{error:?}")),
            Err(_) => return Ok(()),
        };
        moved = true;
        warned |= !report.warnings.is_empty();
        finite(&simulation, frame)?;
        let spent = report.warnings.iter().any(|warning| matches!(warning, Warning::BudgetSpent { .. }));
        if settings.integrator.projects() && !spent {
            // A step that is solved at its end comes back from where its velocity would have led.
            residuals(&mut simulation, settings.constraint_tolerance, settings.h * speed)?;
        }
    }
    // Fixed steps may blow up in plain sight, and a tolerance of a scene may be large.
    let accurate = settings.integrator.is_adaptive() && settings.tolerance <= 1e-3;
    let missing = simulation.energy_error_max();
    if moved && accurate && !warned && (missing.is_nan() || missing > ENERGY) {
        return fault("energy", format!("{missing:.1e} of the largest kinetic energy is missing without a warning"));
    }
    Ok(())
}

fn finite(simulation: &Simulation, frame: usize) -> Result<(), Fault> {
    let state = simulation.state();
    let numbers = state.positions().iter().chain(state.velocities());
    if numbers.clone().any(|number| !number.is_finite()) {
        return fault("not finite", format!("positions or velocities after frame {frame}"));
    }
    let energy = simulation.energy();
    if !(energy.total().is_finite() && energy.work.total().is_finite()) {
        return fault("not finite", format!("the energy after frame {frame}: {energy:?}"));
    }
    Ok(())
}

/// Rigid rows that act are satisfied as well as the settings ask, up to the roundoff of positions and of a way \[m\].
fn residuals(simulation: &mut Simulation, tolerance: f64, way: f64) -> Result<(), Fault> {
    let terms = simulation.terms();
    let system = simulation.system();
    let size = largest(&terms.positions).max(way);
    for row in (0..system.row_count()).filter(|&row| system.is_rigid(row) && !terms.is_open[row]) {
        let relative = terms.residual[row].abs() / system.row_scales()[row];
        // Coordinates that are large against a row round its residual to more than the tolerance.
        let slope = terms.jacobian.row(row).map(|(_, entries)| largest(entries)).fold(0.0, f64::max);
        let rounded = 1e-13 * size * slope / system.row_scales()[row];
        if relative.is_nan() || relative > 10.0 * tolerance + rounded {
            let name = &system.row_names()[row];
            return fault("residual", format!("`{name}` is off by {relative:.1e} of its scale after a frame"));
        }
    }
    Ok(())
}
