//! Several workloads one after the other, each under its settings.

use crate::names::{NAMES, UnknownWorkload};
use crate::run::{RunError, best};
use crate::setting::{Setting, settings};
use crate::table::Row;
use crate::workload::Workload;
use std::time::Duration;

/// The workloads to measure, with their settings and the limit of time.
#[derive(Clone, Debug)]
pub struct Series {
    names: Vec<String>,
    setting: Option<Setting>,
    limit: Duration,
}

impl Series {
    /// The workloads of these names, or all workloads without names. They run under `setting`, or without it under all
    /// settings of each workload ([`settings`]). A run is stopped after `limit` of CPU time.
    ///
    /// # Errors
    /// A name that no workload has. All names are checked before the first run.
    pub fn new(names: &[impl AsRef<str>], setting: Option<Setting>, limit: Duration) -> Result<Self, UnknownWorkload> {
        let mut names: Vec<String> = names.iter().map(|name| name.as_ref().to_owned()).collect();
        if names.is_empty() {
            names = NAMES.map(String::from).into();
        }
        for name in &names {
            name.parse::<Workload>()?;
        }
        Ok(Series { names, setting, limit })
    }

    /// Measures the workloads one after the other; the fastest of up to three runs counts. `each` is called with every
    /// row as soon as it is known.
    ///
    /// # Errors
    /// A run that cannot start, or an error of `each`.
    pub fn run<E: From<UnknownWorkload> + From<RunError>>(
        &self,
        mut each: impl FnMut(&Row) -> Result<(), E>,
    ) -> Result<(), E> {
        for name in &self.names {
            // Each workload is made just before its run, because all of them together would fill the memory.
            let workload: Workload = name.parse()?;
            for setting in self.setting.map_or_else(|| settings(&workload), |setting| vec![setting]) {
                each(&Row::new(&workload, setting, best(&workload, &setting, self.limit)?))?;
            }
        }
        Ok(())
    }
}
