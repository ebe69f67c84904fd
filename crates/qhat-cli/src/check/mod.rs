//! `qhat check`: the errors of a scene, or its degrees of freedom, rank and states of self-stress.
//!
//! ```text
//! degrees of freedom    = coordinates of free particles − rank A
//! states of self-stress = active rows on free particles − rank A
//! ```

mod components;
mod parameters;

use crate::arguments;
use crate::failure::{Failure, NOT_REACHED};
use crate::print::{self, count, small};
use crate::run::frames::Frames;
use crate::source::Source;
use components::Components;
use qhat::{Integrator, ParticleId, Settings, Simulation, Solver, Terms, evaluate, larger};
use qhat_scene::{Scene, SceneErrors};
use serde::Serialize;
use serde_json::json;
use std::process::ExitCode;

/// Checks a scene.
pub(crate) fn check(arguments: &arguments::Check) -> Result<ExitCode, Failure> {
    let source = Source::read(&arguments.scene)?;
    let scene = match source.load(&arguments.parameters.set) {
        Ok(scene) => scene,
        Err(errors) => {
            if arguments.json {
                print::json(&invalid(&errors))?;
            }
            return Err(Failure::formatted(errors));
        }
    };
    let findings = Findings::of(&scene);
    if arguments.json {
        print::json(&findings)?;
    } else {
        findings.print()?;
    }
    Ok(if findings.feasible && findings.refused.is_none() { ExitCode::SUCCESS } else { ExitCode::from(NOT_REACHED) })
}

fn invalid(errors: &SceneErrors) -> serde_json::Value {
    let list = errors.errors.iter().map(|error| {
        json!({ "line": error.line, "column": error.column, "message": error.message, "help": error.help,
            "also": error.also })
    });
    json!({ "valid": false, "errors": list.collect::<Vec<_>>(), "more_errors": errors.more })
}

/// The findings of a check of a valid scene.
#[derive(Debug, Serialize)]
struct Findings {
    valid: bool,
    scene: String,
    dimension: usize,
    particles: usize,
    free_particles: usize,
    rods: usize,
    /// The parameters, with the numbers that depend on each.
    parameters: Vec<parameters::Found>,
    rows: usize,
    rows_on_free_particles: usize,
    /// Rows on free particles that are inactive at the start, because their contacts are open.
    open_rows: usize,
    /// max |C| at the positions in the file.
    max_residual_at_start: f64,
    worst_row_at_start: Option<String>,
    consistent_at_start: bool,
    /// Whether every constraint holds at some positions near the start.
    feasible: bool,
    /// The largest distance of a particle from its position in the file to those positions \[m\].
    start_moved: Option<f64>,
    /// The largest change of a velocity at the start [m/s].
    start_velocity_changed: Option<f64>,
    /// Whether that change is more than the tolerance explains.
    #[serde(skip)]
    is_turned: bool,
    /// The reason for which `qhat run` would refuse the scene; none where it would not.
    refused: Option<String>,
    /// The rank of A at those positions, as are all numbers below; none where A is singular and too large to count.
    rank: Option<usize>,
    degrees_of_freedom: Option<usize>,
    /// Those of the mechanism at positions near by, where rods hold joints only to second order; else none.
    degrees_of_freedom_nearby: Option<usize>,
    /// The joints of each group that rods hold only to second order.
    second_order: Vec<Vec<String>>,
    states_of_self_stress: Option<usize>,
    redundant: Option<bool>,
    /// The connected components of A; equal components are counted in one entry.
    components: Vec<Components>,
    /// The first frame of a run of the scene; none where that frame fails.
    first_frame: Option<Beginning>,
    warnings: Vec<String>,
}

/// The integrator and the solver of the first frame.
#[derive(Debug, Serialize)]
struct Beginning {
    integrator: &'static str,
    carried_by: &'static str,
    #[serde(serialize_with = "print::display")]
    solver: Solver,
}

impl Beginning {
    fn of(scene: &Scene) -> Option<Self> {
        let report = scene.simulation().and_then(|mut simulation| simulation.step()).ok()?;
        let integrator = scene.settings.integrator.name();
        Some(Beginning { integrator, carried_by: report.integrator.name(), solver: report.solver })
    }

    fn in_words(&self) -> String {
        let choice = if self.integrator == self.carried_by { "" } else { &format!(": {}", self.carried_by) };
        format!("{}{choice}, {}", self.integrator, print::path(self.solver))
    }
}

/// The most entries of components that are printed; of the smaller components only the number is printed.
const LISTED: usize = 4;

impl Findings {
    fn of(scene: &Scene) -> Self {
        let system = &scene.system;
        let start = evaluate(system, &scene.state);
        let relative = |row: usize| start.residual[row].abs() / system.row_scales()[row];
        // The residual of a compliant row is its load, not an error.
        let rigid = || (0..system.row_count()).filter(|&row| system.is_rigid(row));
        let worst = rigid().max_by(|&a, &b| relative(a).total_cmp(&relative(b)));
        let consistent = worst.is_none_or(|row| relative(row) <= scene.settings.constraint_tolerance);

        // An integrator that projects finds the nearest consistent start, and uses A without diagonal drag. DOP853 is
        // the one that finds events, too.
        let settings = Settings { integrator: Integrator::Dop853, ..scene.settings };
        let simulation = Simulation::new(system.clone(), scene.state.clone(), settings);
        let mut warnings: Vec<String> = Vec::new();
        let (mut freedom, mut second_order) = (None, Vec::new());
        let (terms, projection) = match simulation {
            Ok(mut simulation) => {
                freedom = simulation.freedom();
                let name = |id: &ParticleId| system.particle_names()[id.index()].clone();
                let cliques = simulation.second_order().iter();
                second_order = cliques.map(|clique| clique.particles.iter().map(name).collect()).collect();
                (simulation.terms(), Some(simulation.projection().clone()))
            }
            Err(error) => {
                warnings.push(error.to_string());
                (start.clone(), None)
            }
        };
        let feasible = projection.is_some();
        warnings.extend(terms.warnings.iter().filter(|_| feasible).map(ToString::to_string));

        let free_particles = terms.inverse_masses.iter().filter(|&&w| w > 0.0).count();
        let coordinates = free_particles * system.dimension();
        let on_free = || rigid().filter(|&row| is_on_free_particle(&terms, row));
        let open_rows = on_free().filter(|&row| terms.is_open[row]).count();
        let rows = on_free().count() - open_rows;
        // Where the constraints cannot hold, the system has no configuration whose rank could be counted.
        // Where rods hold only to second order, the rank of the terms is that of the rows that hold instead.
        let rank = match freedom {
            Some(freedom) => Some(coordinates - freedom.here),
            None => terms.rank.filter(|_| feasible),
        };
        Findings {
            valid: true,
            scene: scene.name.clone(),
            dimension: system.dimension(),
            particles: system.particle_count(),
            free_particles,
            rods: system.links().filter(|link| link.is_rod()).count(),
            parameters: parameters::Found::all(system),
            rows: system.row_count(),
            rows_on_free_particles: rows + open_rows,
            open_rows,
            max_residual_at_start: rigid().fold(0.0, |max, row| larger(max, start.residual[row].abs())),
            worst_row_at_start: worst.filter(|_| !consistent).map(|row| system.row_names()[row].clone()),
            consistent_at_start: consistent,
            feasible,
            start_moved: projection.as_ref().map(|projection| projection.moved),
            start_velocity_changed: projection.as_ref().map(|projection| projection.velocity_changed),
            is_turned: projection.is_some_and(|projection| projection.is_turned),
            refused: refused(scene),
            rank,
            degrees_of_freedom: rank.map(|rank| coordinates.saturating_sub(rank)),
            degrees_of_freedom_nearby: freedom.map(|freedom| freedom.nearby),
            second_order,
            states_of_self_stress: rank.map(|rank| rows.saturating_sub(rank)),
            // The rank is not counted only where A is singular.
            redundant: feasible.then(|| rank.is_none_or(|rank| rank < rows)),
            components: Components::alike(system.components()),
            first_frame: if feasible { Beginning::of(scene) } else { None },
            warnings,
        }
    }

    fn print(&self) -> Result<(), Failure> {
        let size = format!(
            "{}, {} of them free to move, in {} dimensions",
            count(self.particles, "particle"),
            self.free_particles,
            self.dimension
        );
        let open = if self.open_rows == 0 { String::new() } else { format!(", {} open", self.open_rows) };
        let rows = format!(
            "{}, {} of them on free particles{open}; {}",
            count(self.rows, "row"),
            self.rows_on_free_particles,
            count(self.rods, "rod")
        );
        let mut lines = vec![("particles", size), ("constraints", rows), ("start", self.start())];
        if let Some(change) = self.start_velocity_changed.filter(|_| self.is_turned) {
            let text = format!("every velocity is as the constraints allow after changes of up to {change:.3e} m/s");
            lines.push(("velocities", text));
        }
        match (self.rank, self.degrees_of_freedom, self.states_of_self_stress) {
            (Some(rank), Some(freedom), Some(stress)) => {
                lines.push(("rank", format!("{rank}: {}", redundancy(stress))));
                let nearby = self.degrees_of_freedom_nearby;
                let nearby = nearby.map(|nearby| format!(" at this position, {nearby} of the mechanism near by"));
                lines.push(("freedom", freedoms(freedom) + &nearby.unwrap_or_default()));
            }
            _ if self.feasible => {
                lines.push(("rank", "some rows are redundant; the system is too large to count them".into()));
            }
            _ => {}
        }
        lines.extend(self.parameters.iter().map(|parameter| ("parameter", parameter.in_words())));
        lines.extend(self.components.iter().take(LISTED).map(|components| ("component", components.in_words())));
        let others: usize = self.components.iter().skip(LISTED).map(|components| components.count).sum();
        if others > 0 {
            lines.push(("component", format!("and {others} smaller")));
        }
        lines.extend(self.first_frame.iter().map(|beginning| ("first frame", beginning.in_words())));
        lines.extend(self.refused.iter().map(|reason| ("run", format!("refused: {reason}"))));
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        print::table(&format!("{}: {}", self.scene, self.verdict()), &lines)
    }

    fn verdict(&self) -> &'static str {
        match (self.feasible, &self.refused) {
            (false, _) => "valid, but its constraints cannot all hold",
            (true, Some(_)) => "valid, but `qhat run` would refuse it",
            (true, None) => "valid",
        }
    }

    fn start(&self) -> String {
        match (&self.worst_row_at_start, self.start_moved) {
            (None, _) if self.max_residual_at_start == 0.0 => "every constraint holds exactly".into(),
            (None, _) => format!("every constraint holds, to {}", small(self.max_residual_at_start)),
            (Some(row), Some(moved)) => {
                format!("`{row}` is the farthest off; every constraint holds after moves of up to {moved:.3e} m")
            }
            (Some(row), None) => {
                format!("`{row}` is the farthest off, and at no positions near by every constraint holds")
            }
        }
    }
}

/// The reason for which `qhat run` would refuse a scene; `None` where it would not.
fn refused(scene: &Scene) -> Option<String> {
    let frames = Frames::new(scene.duration, None, &scene.settings);
    let is_adaptive = scene.settings.integrator.is_adaptive();
    let checked = frames.and_then(|frames| if is_adaptive { Ok(()) } else { frames.check(&scene.settings) });
    checked.err().map(|failure| failure.message().replace('\n', "; "))
}

fn is_on_free_particle(terms: &Terms, row: usize) -> bool {
    terms.jacobian.row(row).any(|(particle, _)| terms.inverse_masses[particle.index()] > 0.0)
}

fn redundancy(states_of_self_stress: usize) -> String {
    match states_of_self_stress {
        0 => "no row is redundant, so every tension is unique".into(),
        1 => "one redundant row; one state of self-stress, so some tensions are not unique".into(),
        k => format!("{k} redundant rows; {k} states of self-stress, so some tensions are not unique"),
    }
}

fn freedoms(degrees_of_freedom: usize) -> String {
    match degrees_of_freedom {
        0 => "0 degrees of freedom: nothing can move".into(),
        1 => "1 degree of freedom".into(),
        k => format!("{k} degrees of freedom"),
    }
}
