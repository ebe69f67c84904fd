//! One run: a workload under one setting, with the time of the steps and the errors of the motion.

use crate::errors::Errors;
use crate::setting::Setting;
use crate::workload::Workload;
use cpu_time::ThreadTime;
use qhat::{BuildError, Simulation, StepError};
use std::time::Duration;
use thiserror::Error;

/// The error of a run that cannot start.
#[derive(Debug, Error)]
pub enum RunError {
    /// The workload is too large for the engine.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Settings out of range, or a start that cannot be made consistent.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// The cost and the errors of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// CPU time of the steps alone.
    pub cpu: Duration,
    /// The simulated time that the run reached \[s\].
    pub simulated: f64,
    /// Substeps taken.
    pub substeps: usize,
    /// Factorizations of A.
    pub factorizations: usize,
    /// The errors, measured at the end of each frame.
    pub errors: Errors,
    /// The reason of an early end, if there was one.
    pub ended: Option<String>,
}

impl Outcome {
    /// CPU time per simulated second \[ms\].
    pub fn cost(&self) -> f64 {
        self.cpu.as_secs_f64() * 1e3 / self.simulated
    }
}

/// Simulates a workload until its end, or until a frame ends after `limit` of CPU time. `each` is called with
/// positions and velocities at the end of every frame; its time is not counted.
///
/// # Errors
/// A workload that is too large, settings out of range, or a start that cannot be made consistent. A step that fails
/// ends the run, and [`Outcome::ended`] has the error.
pub fn run(
    workload: &Workload,
    setting: &Setting,
    limit: Duration,
    mut each: impl FnMut(&[f64], &[f64]),
) -> Result<Outcome, RunError> {
    let (system, state) = workload.system()?;
    let mut simulation = Simulation::new(system, state, setting.settings(workload.frame))?;
    let mut outcome = Outcome {
        cpu: Duration::ZERO,
        simulated: 0.0,
        substeps: 0,
        factorizations: 0,
        errors: Errors::of(workload),
        ended: None,
    };
    for frame in 1..=workload.frames {
        let clock = ThreadTime::now();
        let report = simulation.step();
        outcome.cpu += clock.elapsed();
        outcome.simulated = simulation.state().time();
        match report {
            Ok(report) => {
                outcome.substeps += report.substeps;
                outcome.factorizations += report.factorizations;
            }
            Err(error) => {
                outcome.ended = Some(error.to_string());
                break;
            }
        }
        let state = simulation.state();
        outcome.errors.frame(workload, state.positions(), state.velocities());
        each(state.positions(), state.velocities());
        if frame < workload.frames && outcome.cpu >= limit {
            outcome.ended = Some(format!("too slow: stopped after {:.0} s of CPU time", limit.as_secs_f64()));
            break;
        }
    }
    Ok(outcome)
}

/// The fastest of up to three runs.
///
/// # Errors
/// The same errors as [`run`].
pub fn best(workload: &Workload, setting: &Setting, limit: Duration) -> Result<Outcome, RunError> {
    let again = || run(workload, setting, limit, |_, _| ());
    quickest(again()?, again)
}

/// The first run with the CPU time of the fastest of up to three equal runs, as many as fit into a second. The fastest
/// counts, because other programs on the machine can only add time.
///
/// # Errors
/// The errors of the runs.
pub fn quickest(first: Outcome, again: impl Fn() -> Result<Outcome, RunError>) -> Result<Outcome, RunError> {
    const RUNS: usize = 3;
    let (mut best, mut spent) = (first.clone(), first.cpu);
    for _ in 1..RUNS {
        if first.ended.is_some() || spent >= Duration::from_secs(1) {
            break;
        }
        let next = again()?;
        spent += next.cpu;
        best.cpu = best.cpu.min(next.cpu);
    }
    Ok(best)
}
