//! Several workloads one after the other, each at its settings.

use crate::names::{NAMES, UnknownWorkload};
use crate::run::best;
use crate::setting::{Setting, settings};
use crate::table::Row;
use crate::workload::Workload;
use qhat::StepError;
use std::time::Duration;

/// Which workloads to measure, and how.
#[derive(Clone, Debug)]
pub struct Series {
    names: Vec<String>,
    setting: Option<Setting>,
    limit: Duration,
}

impl Series {
    /// The workloads of these names, or all where none is named, at one setting or at those that each is measured at. A
    /// run is stopped after `limit` of CPU time.
    ///
    /// # Errors
    /// A name that is no workload's: told before anything is run.
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

    /// Measures one after the other, the quickest of up to three runs each; `each` sees every row as soon as it is
    /// known.
    ///
    /// # Errors
    /// A run that cannot start, or what `each` ends with.
    pub fn run<E: From<UnknownWorkload> + From<StepError>>(
        &self,
        mut each: impl FnMut(&Row) -> Result<(), E>,
    ) -> Result<(), E> {
        for name in &self.names {
            // Made here, because all at once they would fill the memory.
            let workload: Workload = name.parse()?;
            for setting in self.setting.map_or_else(|| settings(&workload), |setting| vec![setting]) {
                each(&Row::new(&workload, setting, best(&workload, &setting, self.limit)?))?;
            }
        }
        Ok(())
    }
}
