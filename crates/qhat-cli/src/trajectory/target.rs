//! The output file of a trajectory. It replaces an existing file only with --force, and appears only when complete.

use super::Format;
use crate::failure::Failure;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The file asked for, its format, and whether it may be replaced.
#[derive(Debug)]
pub(crate) struct Target {
    path: PathBuf,
    format: Format,
    force: bool,
}

impl Target {
    /// Checks the name and the folder, before anything is computed.
    ///
    /// # Errors
    /// An unknown ending, a missing folder, a file that exists without `force`.
    pub(crate) fn new(path: &Path, force: bool) -> Result<Self, Failure> {
        let target = Target { path: path.to_owned(), format: Format::of(path)?, force };
        if !target.folder().is_dir() {
            return Err(Failure::input(format!("there is no folder `{}` to write in", target.folder().display())));
        }
        for path in target.files() {
            if path.is_dir() {
                return Err(Failure::input(format!("`{}` is a folder", path.display())));
            }
            if !force && path.symlink_metadata().is_ok() {
                return Err(exists(&path));
            }
        }
        Ok(target)
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file beside a CSV that holds its origin.
    pub(crate) fn origin_path(&self) -> PathBuf {
        let mut name = self.path.clone().into_os_string();
        name.push(".json");
        name.into()
    }

    /// A file without a name in the folder of the target, removed when it is closed.
    pub(crate) fn scratch(&self) -> Result<File, Failure> {
        tempfile::tempfile_in(self.folder()).map_err(|error| self.cannot_write(&error))
    }

    /// A temporary file beside the target, for [`Target::put`]; removed if it is not renamed.
    pub(crate) fn temporary(&self) -> Result<NamedTempFile, Failure> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".qhat-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The permissions of a new file, less the umask; by default only the user could read a temporary file.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        builder.tempfile_in(self.folder()).map_err(|error| self.cannot_write(&error))
    }

    /// Renames a finished file to the target.
    pub(crate) fn put(&self, file: NamedTempFile) -> Result<(), Failure> {
        self.put_as(file, &self.path)
    }

    /// Writes the origin beside the target.
    pub(crate) fn put_origin(&self, origin: &str) -> Result<(), Failure> {
        let mut file = self.temporary()?;
        writeln!(file, "{origin}").map_err(|error| self.cannot_write(&error))?;
        self.put_as(file, &self.origin_path())
    }

    /// The failure of a write.
    pub(crate) fn cannot_write(&self, error: &io::Error) -> Failure {
        Failure::io(format!("cannot write `{}`", self.path.display()), error)
    }

    fn put_as(&self, file: NamedTempFile, path: &Path) -> Result<(), Failure> {
        let outcome = if self.force { file.persist(path) } else { file.persist_noclobber(path) };
        match outcome {
            Ok(_) => Ok(()),
            // Another process made the file during the run.
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => Err(exists(path)),
            Err(failed) => Err(self.cannot_write(&failed.error)),
        }
    }

    fn files(&self) -> Vec<PathBuf> {
        match self.format {
            Format::Npz => vec![self.path.clone()],
            Format::Csv => vec![self.path.clone(), self.origin_path()],
        }
    }

    fn folder(&self) -> &Path {
        match self.path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        }
    }
}

fn exists(path: &Path) -> Failure {
    Failure::input(format!("`{}` exists; nothing was written. Use --force to replace it", path.display()))
}
