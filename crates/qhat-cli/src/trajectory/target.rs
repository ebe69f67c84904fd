//! Where a trajectory goes: never over a file that exists unless told so, and never half of it.

use super::Format;
use crate::failure::Failure;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The file asked for, and whether it may be replaced.
#[derive(Debug)]
pub(crate) struct Target {
    path: PathBuf,
    format: Format,
    force: bool,
}

impl Target {
    /// Checks name and place before anything is computed.
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

    /// The file that tells the origin of a CSV, which has no place for it inside.
    pub(crate) fn origin_path(&self) -> PathBuf {
        let mut name = self.path.clone().into_os_string();
        name.push(".json");
        name.into()
    }

    /// A file without a name on the disk of the target, gone when it is closed.
    pub(crate) fn scratch(&self) -> Result<File, Failure> {
        tempfile::tempfile_in(self.folder()).map_err(|error| self.cannot_write(&error))
    }

    /// A file beside the target that [`Target::put`] can rename; removed if that never happens.
    pub(crate) fn temporary(&self) -> Result<NamedTempFile, Failure> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".qhat-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // As any new file of the user, less the umask; without this it would be for the user's eyes only.
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

    /// What to say when writing fails.
    pub(crate) fn cannot_write(&self, error: &io::Error) -> Failure {
        Failure::io(format!("cannot write `{}`", self.path.display()), error)
    }

    fn put_as(&self, file: NamedTempFile, path: &Path) -> Result<(), Failure> {
        let outcome = if self.force { file.persist(path) } else { file.persist_noclobber(path) };
        match outcome {
            Ok(_) => Ok(()),
            // Made by someone else while this ran.
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
    Failure::input(format!("`{}` exists; nothing was written. Use --force to write over it", path.display()))
}
