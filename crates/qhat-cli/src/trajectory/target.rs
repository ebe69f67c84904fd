//! Where a trajectory goes, and the file that tells its origin.

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
    /// Checks name and place before anything is computed.
    pub(crate) fn new(path: &Path, force: bool) -> Result<Self, Failure> {
        let format = Format::of(path)?;
        let companions = match format {
            Format::Npz => Vec::new(),
            Format::Csv => vec![origin_path(path)],
        };
        Ok(Target { output: Output::new(path, &companions, force)?, format })
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn path(&self) -> &Path {
        self.output.path()
    }

    /// A file without a name on the disk of the target, gone when it is closed.
    pub(crate) fn scratch(&self) -> Result<File, Failure> {
        self.output.scratch()
    }

    /// A file beside the target that [`Target::put`] can rename; removed if that never happens.
    pub(crate) fn temporary(&self) -> Result<NamedTempFile, Failure> {
        self.output.temporary()
    }

    /// Renames a finished file to the target.
    pub(crate) fn put(&self, file: NamedTempFile) -> Result<(), Failure> {
        self.output.put(file)
    }

    /// Writes the origin of a CSV beside it: a CSV has no place for it inside.
    pub(crate) fn put_origin(&self, origin: &str) -> Result<(), Failure> {
        let mut file = self.temporary()?;
        writeln!(file, "{origin}").map_err(|error| self.cannot_write(&error))?;
        self.output.put_as(file, &origin_path(self.path()))
    }

    /// What to say when writing fails.
    pub(crate) fn cannot_write(&self, error: &io::Error) -> Failure {
        self.output.cannot_write(error)
    }
}

fn origin_path(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".json");
    name.into()
}
