//! The summary at the end of a run.

use super::events::Events;
use super::origin::Origin;
use crate::failure::Failure;
use crate::print::{self, count, small};
use crate::status::Status;
use qhat::{Integrator, Simulation, Solver, StepReport, System, Terms, Warning};
use serde::Serialize;
use std::time::Duration;

/// Counts and maxima over a run.
#[derive(Debug, Default)]
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
    pub(super) cpu: Duration,
    pub(super) warnings: Vec<String>,
    /// The warning of the frame that spent its budget and ended farthest off: its place in `warnings`, and its relative
    /// error.
    worst_budget: Option<(usize, f64)>,
    /// The number of frames of each integrator and solver, in the order of their first frames.
    carried: Vec<Carried>,
    events: Events,
    max_tension: Option<MaxTension>,
}

/// The largest tension or thrust of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct MaxTension {
    /// \[N\]; negative if it is a thrust.
    tension: f64,
    link: String,
    /// \[s\].
    time: f64,
}

/// The number of frames that one integrator advanced with one solver of the multipliers.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Carried {
    integrator: &'static str,
    #[serde(serialize_with = "print::display")]
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
            self.max_relative_length_error = self.max_relative_length_error.max(relative);
        }
    }

    /// Notes the terms of a frame.
    pub(super) fn frame(&mut self, system: &System, terms: &Terms) {
        self.frames += 1;
        let rigid = (0..system.row_count()).filter(|&row| system.is_rigid(row));
        self.max_residual = rigid.fold(self.max_residual, |max, row| max.max(terms.residual[row].abs()));
        terms.warnings.iter().for_each(|warning| self.warn(warning));
    }

    /// Notes the report of a step to the next frame.
    pub(super) fn step(&mut self, system: &System, report: &StepReport) {
        self.substeps += report.substeps;
        self.rejected += report.rejected;
        self.max_residual = self.max_residual.max(report.max_residual);
        self.max_relative_length_error = self.max_relative_length_error.max(report.max_relative_length_error);
        self.carry(report.integrator, report.solver);
        if let Some(largest) = report.max_tension
            && self.max_tension.as_ref().is_none_or(|former| former.tension.abs() < largest.tension.abs())
        {
            let link = system.constraint_of(largest.link).name.clone();
            self.max_tension = Some(MaxTension { tension: largest.tension, link, time: largest.time });
        }
        report.events.iter().for_each(|event| self.events.note(event));
        report.warnings.iter().for_each(|warning| self.warn(warning));
    }

    fn carry(&mut self, integrator: Integrator, solver: Solver) {
        let integrator = integrator.name();
        let mut known = self.carried.iter_mut();
        match known.find(|carried| carried.integrator == integrator && carried.solver == solver) {
            Some(carried) => carried.frames += 1,
            None => self.carried.push(Carried { integrator, solver, frames: 1 }),
        }
    }

    /// Notes the time and the energy error of the current state, at a frame or where a step failed.
    pub(super) fn reached(&mut self, simulation: &Simulation) {
        self.time_reached = simulation.state().time();
        self.energy_error = simulation.energy_error();
        self.energy_error_max = simulation.energy_error_max();
    }

    fn warn(&mut self, warning: &Warning) {
        let words = warning.to_string();
        if let Warning::BudgetSpent { relative, .. } = *warning {
            match self.worst_budget {
                Some((_, before)) if before >= relative => return,
                Some((place, _)) => self.warnings[place] = words,
                None => self.warnings.push(words),
            }
            let place = self.worst_budget.map_or(self.warnings.len() - 1, |(place, _)| place);
            self.worst_budget = Some((place, relative));
        } else if !self.warnings.contains(&words) {
            self.warnings.push(words);
        }
    }
}

/// The summary, as `--json` prints it.
#[derive(Debug, Serialize)]
pub(crate) struct Summary<'a> {
    status: Status,
    error: Option<&'a str>,
    scene: &'a str,
    integrator: &'a str,
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
    warnings: &'a [String],
    output: Option<String>,
}

impl<'a> Summary<'a> {
    pub(super) fn new(origin: &'a Origin, tally: &'a Tally, wall: Duration, output: Option<String>) -> Self {
        Summary {
            status: origin.status,
            error: origin.error.as_deref(),
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
            warnings: &tally.warnings,
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
        if let Some(MaxTension { tension, link, time }) = self.max_tension {
            let line = format!("at most {} N in {link} at {time:.2} s", significant(*tension));
            lines.insert(lines.len() - 1, ("tension", line));
        }
        if let Some(carriers) = self.carriers() {
            lines.insert(2, ("carried by", carriers));
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

/// A force in four digits, without an exponent.
fn significant(force: f64) -> String {
    if force == 0.0 {
        return "0".into();
    }
    let decimals = (3 - force.abs().log10().floor() as i32).clamp(0, 9) as usize;
    format!("{force:.decimals$}")
}
