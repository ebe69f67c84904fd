//! Every shipped scene with its own settings, three times.

use cpu_time::ThreadTime;
use qhat::{StepError, larger};
use qhat_scene::{Scene, shipped};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::time::Duration;

/// Simulated time of one case \[s\]: long enough for chains to whip, short enough to run all scenes in a minute.
const SIMULATED: f64 = 2.0;

/// Runs of a case. The fastest counts, because other programs on the machine can only add time.
const RUNS: usize = 3;

struct Outcome {
    cpu: Duration,
    substeps: usize,
    length_error: f64,
    energy_error: f64,
    energy_error_max: f64,
}

/// Runs the scenes of these names, or all scenes without names. Prints a table, and writes the file if all were run.
///
/// # Errors
/// A scene that fails, or a file that cannot be written.
pub fn scenes(wanted: &[String], results: &Path) -> Result<(), Box<dyn Error>> {
    let mut csv = String::from(
        "scene,integrator,rows,simulated_s,cpu_ms_per_simulated_s,us_per_substep,substeps,\
         max_relative_length_error,energy_error,energy_error_max\n",
    );
    println!(
        "{:<18} {:>17} {:>6} {:>12} {:>12} {:>9} {:>13} {:>13}",
        "scene", "integrator", "rows", "CPU ms/sim s", "µs/substep", "substeps", "length error", "energy error"
    );
    for scene in shipped().iter().filter(|scene| wanted.is_empty() || wanted.iter().any(|name| name == scene.name)) {
        let name = scene.name;
        let scene = scene.load()?;
        let mut best = run(&scene)?;
        for _ in 1..RUNS {
            let again = run(&scene)?;
            best.cpu = best.cpu.min(again.cpu);
        }
        let cost = best.cpu.as_secs_f64() * 1e3 / SIMULATED;
        let substep = best.cpu.as_secs_f64() * 1e6 / best.substeps as f64;
        let (rows, integrator) = (scene.system.row_count(), scene.settings.integrator.name());
        println!(
            "{name:<18} {integrator:>17} {rows:>6} {cost:>12.3} {substep:>12.2} {:>9} {:>13.1e} {:>13.1e}",
            best.substeps, best.length_error, best.energy_error
        );
        writeln!(
            csv,
            "{name},{integrator},{rows},{SIMULATED},{cost:.4},{substep:.3},{},{:e},{:e},{:e}",
            best.substeps, best.length_error, best.energy_error, best.energy_error_max
        )?;
    }
    if wanted.is_empty() {
        fs::write(results.join("scenes.csv"), csv)?;
    }
    Ok(())
}

/// One run of a scene; only the time of the steps counts.
fn run(scene: &Scene) -> Result<Outcome, StepError> {
    let mut simulation = scene.simulation()?;
    let frames = (SIMULATED / scene.settings.h).round() as usize;
    let (mut substeps, mut length_error) = (0, 0.0_f64);
    let start = ThreadTime::now();
    for _ in 0..frames {
        let report = simulation.step()?;
        substeps += report.substeps;
        length_error = larger(length_error, report.max_relative_length_error);
    }
    Ok(Outcome {
        cpu: start.elapsed(),
        substeps,
        length_error,
        energy_error: simulation.energy_error(),
        energy_error_max: simulation.energy_error_max(),
    })
}
