//! CSV: a header, then one line a frame. The format has no place for the origin, which goes into FILE.csv.json.

use super::target::Target;
use crate::failure::Failure;
use qhat::{System, Terms};
use std::fmt::Write;
use std::io;
use tempfile::NamedTempFile;

const AXES: [&str; 3] = ["x", "y", "z"];

/// A trajectory being written as CSV.
pub(crate) struct Recorder {
    target: Target,
    csv: csv::Writer<NamedTempFile>,
    number: String,
}

impl Recorder {
    pub(super) fn new(target: Target, system: &System) -> Result<Self, Failure> {
        let csv = csv::Writer::from_writer(target.temporary()?);
        let mut recorder = Recorder { target, csv, number: String::new() };
        recorder.csv.write_record(columns(system)).map_err(|error| recorder.failed(error))?;
        Ok(recorder)
    }

    pub(super) fn frame(&mut self, time: f64, terms: &Terms) -> Result<(), Failure> {
        let is_unique = super::as_numbers(&terms.tension_is_unique);
        let arrays: [&[f64]; 7] = [
            &[time],
            &terms.positions,
            &terms.velocities,
            &terms.constraint_forces,
            &terms.multipliers,
            &terms.tension,
            &is_unique,
        ];
        self.write(arrays.into_iter().flatten()).map_err(|error| self.failed(error))
    }

    pub(super) fn finish(self, origin: &str) -> Result<(), Failure> {
        let file = self.csv.into_inner().map_err(|failed| self.target.cannot_write(failed.error()))?;
        // The origin comes first, so that no CSV is ever without its origin.
        self.target.put_origin(origin)?;
        self.target.put(file)
    }

    fn write<'a>(&mut self, numbers: impl Iterator<Item = &'a f64>) -> csv::Result<()> {
        for number in numbers {
            self.number.clear();
            // The shortest decimal that reads back as the same bits, with an exponent where that is shorter.
            let _ = write!(self.number, "{number:?}");
            self.csv.write_field(&self.number)?;
        }
        self.csv.write_record(None::<&[u8]>)
    }

    fn failed(&self, error: csv::Error) -> Failure {
        self.target.cannot_write(&io::Error::other(error))
    }
}

/// The names of the columns: `t`, positions `bob.x` …, velocities `bob.vx` …, constraint forces `bob.fx` …,
/// `row.multiplier` …, `link.tension` …, `link.tension_is_unique` ….
fn columns(system: &System) -> Vec<String> {
    let mut columns = vec!["t".to_owned()];
    for quantity in ["", "v", "f"] {
        for name in system.particle_names() {
            columns.extend(AXES[..system.dimension()].iter().map(|axis| format!("{name}.{quantity}{axis}")));
        }
    }
    columns.extend(system.row_names().iter().map(|row| format!("{row}.multiplier")));
    columns.extend(system.links().map(|link| format!("{}.tension", link.name)));
    columns.extend(system.links().map(|link| format!("{}.tension_is_unique", link.name)));
    columns
}
