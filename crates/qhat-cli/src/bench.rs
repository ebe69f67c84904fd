//! `qhat bench`: the cost and the errors of workloads of known shape on this machine.

use crate::arguments;
use crate::failure::Failure;
use crate::print;
use qhat_bench::{NAMES, Row, Setting, Workload, best, settings};
use std::fs::File;
use std::io::Write;
use std::process::ExitCode;
use std::time::Duration;

/// Runs the workloads named, or all.
pub(crate) fn bench(arguments: &arguments::Bench) -> Result<ExitCode, Failure> {
    // All is read before anything is run or written.
    let all = || NAMES.iter().map(ToString::to_string).collect();
    let names: Vec<String> = if arguments.workloads.is_empty() { all() } else { arguments.workloads.clone() };
    let known = names.iter().map(|name| name.parse::<Workload>().map(|_| name)).collect::<Result<Vec<_>, _>>();
    let names = known.map_err(Failure::input)?;
    let one = arguments.setting.as_deref().map(str::parse::<Setting>).transpose().map_err(Failure::input)?;
    let limit = Duration::try_from_secs_f64(arguments.limit)
        .map_err(|_| Failure::input(format!("--limit must be a time in seconds, but is {}", arguments.limit)))?;
    let mut csv = arguments.csv.as_deref().map(Csv::create).transpose()?;

    print::text(&Row::heading())?;
    for name in names {
        let workload: Workload = name.parse().map_err(Failure::input)?;
        for setting in one.map_or_else(|| settings(&workload), |setting| vec![setting]) {
            let outcome = best(&workload, &setting, limit).map_err(Failure::input)?;
            let row = Row::new(&workload, setting, outcome);
            print::text(&row.to_string())?;
            if let Some(csv) = &mut csv {
                csv.line(&row.csv())?;
            }
        }
    }
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
