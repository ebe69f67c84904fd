//! A row of results, as a line of the table and as a line of the CSV file.

use crate::run::Outcome;
use crate::setting::Setting;
use crate::workload::Workload;
use std::fmt;

/// The result of a workload under a setting.
#[derive(Clone, Debug)]
pub struct Row {
    /// The workload's name.
    pub workload: String,
    /// The setting.
    pub setting: Setting,
    /// The number of rows of C.
    pub rows: usize,
    /// The cost and the errors.
    pub outcome: Outcome,
}

impl Row {
    /// The first line of a CSV.
    pub const CSV: &str = "workload,integrator,tolerance,rows,simulated_s,cpu_ms_per_simulated_s,us_per_substep,\
        ns_per_row_and_substep,substeps,factorizations,worst_length_error,rms_length_error,energy_error,\
        energy_error_max,ended";

    /// The row of one run.
    pub fn new(workload: &Workload, setting: Setting, outcome: Outcome) -> Self {
        Row { workload: workload.name.clone(), setting, rows: workload.lengths.len(), outcome }
    }

    /// The heading of the table.
    pub fn heading() -> String {
        format!(
            "{:<10} {:>16} {:>8} {:>12} {:>12} {:>8} {:>9} {:>9} {:>9}",
            "workload", "setting", "rows", "CPU ms/sim s", "µs/substep", "substeps", "worst", "rms", "energy"
        )
    }

    /// CPU time of a substep \[µs\].
    fn substep(&self) -> f64 {
        self.outcome.cpu.as_secs_f64() * 1e6 / self.outcome.substeps.max(1) as f64
    }

    /// The line of a CSV.
    pub fn csv(&self) -> String {
        let Outcome { simulated, substeps, factorizations, errors, ended, .. } = &self.outcome;
        let Setting { integrator, tolerance } = self.setting;
        format!(
            "{},{integrator},{tolerance:e},{},{simulated:.6},{:.4},{:.3},{:.1},{substeps},\
             {factorizations},{:e},{:e},{:e},{:e},\"{}\"",
            self.workload,
            self.rows,
            self.outcome.cost(),
            self.substep(),
            self.substep() * 1e3 / self.rows as f64,
            errors.worst_length,
            errors.rms_length(),
            errors.energy(),
            errors.energy_max(),
            ended.as_deref().unwrap_or_default().replace('"', "'"),
        )
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let errors = &self.outcome.errors;
        write!(
            f,
            "{:<10} {:>16} {:>8} {:>12.3} {:>12.2} {:>8} {:>9.1e} {:>9.1e} {:>9.1e}",
            self.workload,
            self.setting,
            self.rows,
            self.outcome.cost(),
            self.substep(),
            self.outcome.substeps,
            errors.worst_length,
            errors.rms_length(),
            errors.energy()
        )?;
        match &self.outcome.ended {
            Some(why) => write!(f, "  t = {:.4} s: {why}", self.outcome.simulated),
            None => Ok(()),
        }
    }
}
