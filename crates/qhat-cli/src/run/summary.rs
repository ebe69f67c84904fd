//! The summary at the end of a run.

use super::events::Events;
use super::origin::Origin;
use crate::failure::Failure;
use crate::print::{self, count, small};
use crate::status::Status;
use qhat::{Digits, Event, Integrator, Simulation, Solver, StepReport, System, Terms, WarningLog, larger};
use serde::{Deserialize, Serialize, Serializer};
use std::time::Duration;

/// The energy error, over the largest kinetic energy, above which the summary begins with it [1].
const CAREFUL: f64 = 0.01;

/// Counts and maxima over a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Frames reached, the start included.
    pub(super) frames: usize,
    substeps: usize,
    rejected: usize,
    max_residual: f64,
    max_relative_length_error: f64,
    energy_error: f64,
    energy_error_max: f64,
    /// The largest move of a particle to the consistent start \[m\].
    moved: f64,
    /// The largest change of a velocity at the start [m/s].
    velocity_changed: f64,
    /// Whether these changes are more than the tolerances explain.
    start_is_off: [bool; 2],
    /// t of the last good state \[s\].
    pub(super) time_reached: f64,
    /// The CPU time of this process, which no later one goes on counting.
    #[serde(skip)]
    pub(super) cpu: Duration,
    log: WarningLog,
    /// The first integrator that was left to advance a frame and is not adaptive, else the last one.
    carrier: Option<Integrator>,
    /// The number of frames of each integrator and solver, in the order of their first frames.
    carried: Vec<Carried>,
    events: Events,
    /// Every event, for a trajectory that keeps them.
    pub(super) all_events: Option<Vec<Event>>,
    max_tension: Option<MaxTension>,
}

/// The largest tension or thrust of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct MaxTension {
    /// \[N\]; negative if it is a thrust.
    tension: f64,
    link: String,
    /// \[s\].
    time: f64,
    /// Whether no other tensions of redundant links would do the same.
    is_unique: bool,
}

/// The number of frames that one integrator advanced with one solver of the multipliers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Carried {
    integrator: String,
    solver: Solver,
    frames: usize,
}

impl Tally {
    /// Notes the change that made the start consistent.
    pub(super) fn begun(&mut self, simulation: &Simulation) {
        let projection = simulation.projection();
        (self.moved, self.velocity_changed) = (projection.moved, projection.velocity_changed);
        self.start_is_off = [projection.is_moved, projection.is_turned];
    }

    /// Notes the length errors at the start.
    pub(super) fn start(&mut self, system: &System, terms: &Terms) {
        let rods = system.links().filter(|link| link.is_rod()).map(|rod| rod.rows.start);
        for row in rods.filter(|&row| system.is_rigid(row)) {
            let relative = terms.residual[row].abs() / system.row_scales()[row];
            self.max_relative_length_error = larger(self.max_relative_length_error, relative);
        }
    }

    /// Notes the terms of the frame at `time` \[s\].
    pub(super) fn frame(&mut self, system: &System, time: f64, terms: &Terms) {
        self.frames += 1;
        let rigid = (0..system.row_count()).filter(|&row| system.is_rigid(row));
        self.max_residual = rigid.fold(self.max_residual, |max, row| larger(max, terms.residual[row].abs()));
        self.log.note(&terms.warnings, time);
    }

    /// Notes the report of a step to the next frame, which is at `time` \[s\].
    pub(super) fn step(&mut self, system: &System, report: &StepReport, time: f64) {
        self.substeps += report.substeps;
        self.rejected += report.rejected;
        self.max_residual = larger(self.max_residual, report.max_residual);
        self.max_relative_length_error = larger(self.max_relative_length_error, report.max_relative_length_error);
        self.carry(report.integrator, report.solver);
        if let Some(largest) = report.max_tension
            && self.max_tension.as_ref().is_none_or(|former| former.tension.abs() < largest.tension.abs())
        {
            let link = system.constraint_of(largest.link).name.clone();
            let qhat::MaxTension { tension, time, is_unique, .. } = largest;
            self.max_tension = Some(MaxTension { tension, link, time, is_unique });
        }
        report.events.iter().for_each(|event| self.events.note(event));
        if let Some(all) = &mut self.all_events {
            all.extend(report.events.iter().cloned());
        }
        self.log.note(&report.warnings, time);
    }

    fn carry(&mut self, integrator: Integrator, solver: Solver) {
        if self.carrier.is_none_or(Integrator::is_adaptive) {
            self.carrier = Some(integrator);
        }
        let integrator = integrator.name();
        let mut known = self.carried.iter_mut();
        match known.find(|carried| carried.integrator == integrator && carried.solver == solver) {
            Some(carried) => carried.frames += 1,
            None => self.carried.push(Carried { integrator: integrator.to_owned(), solver, frames: 1 }),
        }
    }

    /// Notes the time and the energy error of the current state, at a frame or where a step failed.
    pub(super) fn reached(&mut self, simulation: &Simulation) {
        self.time_reached = simulation.state().time();
        self.energy_error = simulation.energy_error();
        self.energy_error_max = simulation.energy_error_max();
    }

    /// The warnings of the run, each told once.
    pub(super) fn warnings(&self) -> Vec<String> {
        self.log.entries().iter().map(ToString::to_string).collect()
    }

    /// The sentence that the summary of a run with a large energy error begins with.
    fn caution(&self) -> Option<String> {
        if self.energy_error_max <= CAREFUL {
            return None;
        }
        let percent = |share: f64| Digits(100.0 * share.abs());
        let (at_the_end, at_worst) = (percent(self.energy_error), percent(self.energy_error_max));
        let what = if self.energy_error.abs() <= CAREFUL {
            format!("off by up to {at_worst} % of the largest kinetic energy on the way, {at_the_end} % at the end")
        } else if self.energy_error < 0.0 {
            format!("gone: {at_the_end} % of the largest kinetic energy was lost, at worst {at_worst} %")
        } else {
            format!("wrong: {at_the_end} % of the largest kinetic energy came from nowhere, at worst {at_worst} %")
        };
        let advice = self.carrier.unwrap_or_default().energy_advice();
        Some(format!("energy is {what}, so the motion is not that of the scene; {advice}"))
    }
}

/// The summary, as `--json` prints it.
#[derive(Debug, Serialize)]
pub(crate) struct Summary<'a> {
    status: Status,
    error: Option<&'a str>,
    /// Said where the energy is off by more than a hundredth of the largest kinetic energy.
    caution: Option<String>,
    scene: &'a str,
    integrator: &'a str,
    #[serde(serialize_with = "carriers")]
    carried: &'a [Carried],
    events: &'a Events,
    h: f64,
    duration: f64,
    time_reached: f64,
    frames: usize,
    substeps: usize,
    rejected: usize,
    wall_seconds: f64,
    cpu_seconds: f64,
    start_moved: f64,
    start_velocity_changed: f64,
    #[serde(skip)]
    start_is_off: [bool; 2],
    max_residual: f64,
    max_relative_length_error: f64,
    energy_error: f64,
    energy_error_max: f64,
    max_tension: Option<&'a MaxTension>,
    warnings: Vec<String>,
    output: Option<String>,
}

impl<'a> Summary<'a> {
    pub(super) fn new(origin: &'a Origin, tally: &'a Tally, wall: Duration, output: Option<String>) -> Self {
        Summary {
            status: origin.status,
            error: origin.error.as_deref(),
            caution: tally.caution(),
            scene: &origin.scene,
            integrator: origin.integrator,
            carried: &tally.carried,
            events: &tally.events,
            h: origin.h,
            duration: origin.duration,
            time_reached: origin.time_reached,
            frames: tally.frames,
            substeps: tally.substeps,
            rejected: tally.rejected,
            wall_seconds: wall.as_secs_f64(),
            cpu_seconds: tally.cpu.as_secs_f64(),
            start_moved: tally.moved,
            start_velocity_changed: tally.velocity_changed,
            start_is_off: tally.start_is_off,
            max_residual: tally.max_residual,
            max_relative_length_error: tally.max_relative_length_error,
            energy_error: tally.energy_error,
            energy_error_max: tally.energy_error_max,
            max_tension: tally.max_tension.as_ref(),
            warnings: tally.warnings(),
            output,
        }
    }

    fn simulated(&self) -> String {
        match self.status {
            Status::Done => format!("{} s", self.duration),
            _ => format!("{:.6} of {} s", self.time_reached, self.duration),
        }
    }

    /// The integrators and solvers with their numbers of frames; none before the first frame.
    fn carriers(&self) -> Option<String> {
        let each = |carried: &Carried| {
            let frames = count(carried.frames, "frame");
            format!("{} for {frames}, {}", carried.integrator, print::path(carried.solver))
        };
        let list: Vec<String> = self.carried.iter().map(each).collect();
        (!list.is_empty()).then(|| list.join("; "))
    }

    /// Prints the summary as text.
    pub(super) fn print(&self) -> Result<(), Failure> {
        let mut lines = vec![
            ("simulated", format!("{}, {}", self.simulated(), count(self.frames, "frame"))),
            ("integrator", format!("{}, h = {} s, {}", self.integrator, self.h, count(self.substeps, "substep"))),
            ("took", format!("{:.3} s, of it stepping {:.3} s of CPU time", self.wall_seconds, self.cpu_seconds)),
            ("constraints", format!("off by at most {}", small(self.max_residual))),
            ("rods", format!("off by at most {} of their length", small(self.max_relative_length_error))),
            (
                "energy",
                format!(
                    "unaccounted for: {} of the largest kinetic energy at the end, at most {}",
                    small(self.energy_error),
                    small(self.energy_error_max)
                ),
            ),
        ];
        if let Some(MaxTension { tension, link, time, is_unique }) = self.max_tension {
            let shared = if *is_unique { "" } else { ", not unique: redundant links share the load" };
            let line = format!("at most {} N in {link} at {time:.2} s{shared}", significant(*tension));
            lines.insert(lines.len() - 1, ("tension", line));
        }
        if let Some(carriers) = self.carriers() {
            lines.insert(2, ("carried by", carriers));
        }
        if let Some(caution) = &self.caution {
            lines.insert(0, ("caution", caution.clone()));
        }
        lines.extend(self.events.lines().into_iter().map(|line| ("events", line)));
        let [is_moved, is_turned] = self.start_is_off;
        if is_moved {
            lines.push(("start", format!("moved by up to {:.2e} m, so that every constraint holds", self.start_moved)));
        }
        if is_turned {
            let change = self.start_velocity_changed;
            lines.push((
                "start",
                format!("velocities changed by up to {change:.2e} m/s, so that every constraint holds"),
            ));
        }
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        lines
            .push(("output", self.output.clone().unwrap_or_else(|| "none; -o FILE.npz or FILE.csv writes one".into())));
        print::table(&format!("{}: {}", self.scene, self.status), &lines)
    }
}

/// Integrators and solvers by their names.
fn carriers<S: Serializer>(carried: &[Carried], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Named<'a> {
        integrator: &'a str,
        solver: String,
        frames: usize,
    }
    serializer.collect_seq(carried.iter().map(|Carried { integrator, solver, frames }| Named {
        integrator,
        solver: solver.to_string(),
        frames: *frames,
    }))
}

/// A force in four digits, without an exponent.
fn significant(force: f64) -> String {
    if force == 0.0 {
        return "0".into();
    }
    let decimals = (3 - force.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{force:.decimals$}")
}
