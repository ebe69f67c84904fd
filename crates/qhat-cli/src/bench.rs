//! `qhat bench`: the cost and the errors of workloads of known shape on this machine.

use crate::arguments;
use crate::failure::Failure;
use crate::print;
use qhat_bench::{Row, Series, Setting};
use std::fs::File;
use std::io::Write;
use std::process::ExitCode;
use std::time::Duration;

/// Runs the workloads named, or all.
pub(crate) fn bench(arguments: &arguments::Bench) -> Result<ExitCode, Failure> {
    // All is read before anything is run or written.
    let setting = arguments.setting.as_deref().map(str::parse::<Setting>).transpose().map_err(Failure::input)?;
    let limit = Duration::try_from_secs_f64(arguments.limit)
        .map_err(|_| Failure::input(format!("--limit must be a time in seconds, but is {}", arguments.limit)))?;
    let series = Series::new(&arguments.workloads, setting, limit)?;
    let mut csv = arguments.csv.as_deref().map(Csv::create).transpose()?;

    print::text(&Row::heading())?;
    series.run(|row| {
        print::text(&row.to_string())?;
        csv.as_mut().map_or(Ok(()), |csv| csv.line(&row.csv()))
    })?;
    Ok(ExitCode::SUCCESS)
}

/// A file that gets a line as soon as it is known.
struct Csv<'a> {
    path: &'a std::path::Path,
    file: File,
}

impl<'a> Csv<'a> {
    fn create(path: &'a std::path::Path) -> Result<Self, Failure> {
        let file = File::create_new(path).map_err(|error| Failure::io(path.display(), &error))?;
        let mut csv = Csv { path, file };
        csv.line(Row::CSV)?;
        Ok(csv)
    }

    fn line(&mut self, line: &str) -> Result<(), Failure> {
        writeln!(self.file, "{line}").map_err(|error| Failure::io(self.path.display(), &error))
    }
}
