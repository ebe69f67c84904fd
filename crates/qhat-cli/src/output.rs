//! The output file of a command. It replaces an existing file only with --force, and appears only when complete.

use crate::failure::Failure;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The file asked for, and whether it may be replaced.
#[derive(Debug)]
pub(crate) struct Output {
    path: PathBuf,
    force: bool,
}

impl Output {
    /// Checks the name and the folder of the file and of its companions, before anything is computed.
    ///
    /// # Errors
    /// A missing folder, a folder in place of a file, a file that exists without `force`.
    pub(crate) fn new(path: &Path, companions: &[PathBuf], force: bool) -> Result<Self, Failure> {
        let output = Output { path: path.to_owned(), force };
        if !output.folder().is_dir() {
            return Err(Failure::input(format!("there is no folder `{}` to write in", output.folder().display())));
        }
        for path in companions.iter().map(PathBuf::as_path).chain([path]) {
            if path.is_dir() {
                return Err(Failure::input(format!("`{}` is a folder", path.display())));
            }
            if !force && path.symlink_metadata().is_ok() {
                return Err(exists(path));
            }
        }
        Ok(output)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// A file without a name in the folder of the output, removed when it is closed.
    pub(crate) fn scratch(&self) -> Result<File, Failure> {
        tempfile::tempfile_in(self.folder()).map_err(|error| self.cannot_write(&error))
    }

    /// A temporary file beside the output, for [`Output::put`]; removed if it is not renamed.
    pub(crate) fn temporary(&self) -> Result<NamedTempFile, Failure> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".qhat-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The rights of any new file, less the umask; a temporary file has rights for its user only.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        builder.tempfile_in(self.folder()).map_err(|error| self.cannot_write(&error))
    }

    /// Renames a finished file to the output.
    pub(crate) fn put(&self, file: NamedTempFile) -> Result<(), Failure> {
        self.put_as(file, &self.path)
    }

    /// Renames a finished file to a companion of the output.
    pub(crate) fn put_as(&self, file: NamedTempFile, path: &Path) -> Result<(), Failure> {
        let outcome = if self.force { file.persist(path) } else { file.persist_noclobber(path) };
        match outcome {
            Ok(_) => Ok(()),
            // Another program made the file in the meantime.
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => Err(exists(path)),
            Err(failed) => Err(self.cannot_write(&failed.error)),
        }
    }

    /// The failure of a write.
    pub(crate) fn cannot_write(&self, error: &io::Error) -> Failure {
        Failure::io(format!("cannot write `{}`", self.path.display()), error)
    }

    fn folder(&self) -> &Path {
        match self.path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        }
    }
}

/// The ending of a file name, in small letters.
pub(crate) fn ending(path: &Path) -> Option<String> {
    path.extension().map(|ending| ending.to_string_lossy().to_lowercase())
}

fn exists(path: &Path) -> Failure {
    Failure::input(format!("`{}` exists; nothing was written. Use --force to write over it", path.display()))
}
