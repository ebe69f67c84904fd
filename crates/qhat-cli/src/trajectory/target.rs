//! The output file of a trajectory. It replaces an existing file only with --force, and appears only when complete.

use super::Format;
use crate::failure::Failure;
use crate::output::Output;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The file asked for, with its format.
#[derive(Debug)]
pub(crate) struct Target {
    output: Output,
    format: Format,
}

impl Target {
    /// Checks the name and the folder, before anything is computed.
    ///
    /// # Errors
    /// An unknown ending, a missing folder, a file that exists without `force`.
    pub(crate) fn new(path: &Path, force: bool) -> Result<Self, Failure> {
        let format = Format::of(path)?;
        let companions = match format {
            Format::Npz => Vec::new(),
            Format::Csv => vec![beside(path, "json"), beside(path, "events.csv")],
        };
        Ok(Target { output: Output::new(path, &companions, force)?, format })
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn path(&self) -> &Path {
        self.output.path()
    }

    /// A file without a name in the folder of the target, removed when it is closed.
    pub(crate) fn scratch(&self) -> Result<File, Failure> {
        self.output.scratch()
    }

    /// A temporary file beside the target, for [`Target::put`]; removed if it is not renamed.
    pub(crate) fn temporary(&self) -> Result<NamedTempFile, Failure> {
        self.output.temporary()
    }

    /// The same, with the error of the system.
    pub(crate) fn temporary_file(&self) -> io::Result<NamedTempFile> {
        self.output.temporary_file()
    }

    /// Renames a finished file to the target.
    pub(crate) fn put(&self, file: NamedTempFile) -> Result<(), Failure> {
        self.output.put(file)
    }

    /// Writes the origin of a CSV beside it: a CSV has no place for it inside.
    pub(crate) fn put_origin(&self, origin: &str) -> Result<(), Failure> {
        let mut file = self.temporary()?;
        writeln!(file, "{origin}").map_err(|error| self.cannot_write(&error))?;
        self.output.put_as(file, &beside(self.path(), "json"))
    }

    /// Writes the events of a CSV beside it; where there are none, removes those of a former run.
    pub(crate) fn put_events(&self, table: Option<&[u8]>) -> Result<(), Failure> {
        let Some(table) = table else {
            return match std::fs::remove_file(beside(self.path(), "events.csv")) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => Err(self.cannot_write(&error)),
                _ => Ok(()),
            };
        };
        let mut file = self.temporary()?;
        file.write_all(table).map_err(|error| self.cannot_write(&error))?;
        self.output.put_as(file, &beside(self.path(), "events.csv"))
    }

    /// The failure of a write.
    pub(crate) fn cannot_write(&self, error: &io::Error) -> Failure {
        self.output.cannot_write(error)
    }
}

/// The path of a file that belongs to a CSV.
fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(ending);
    name.into()
}
