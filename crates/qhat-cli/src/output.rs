//! The output file of a command. It replaces an existing file only with --force, and appears only when complete.

use crate::failure::Failure;
use std::cell::Cell;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::NamedTempFile;

/// The beginning and the end of the names of temporary files.
const PREFIX: &str = ".qhat-";
const SUFFIX: &str = ".part";

/// Age below which a temporary file is left alone: its process may not have locked it yet.
const YOUNG: Duration = Duration::from_secs(60);

/// The file asked for, and whether it may be replaced.
#[derive(Debug)]
pub(crate) struct Output {
    path: PathBuf,
    /// Whether a file of this name may be replaced: by the option, or because it is an earlier one of this run.
    force: Cell<bool>,
}

impl Output {
    /// Checks the name and the folder of the file and of its companions, before anything is computed.
    ///
    /// # Errors
    /// A missing folder, a folder in place of a file, a file that exists without `force`.
    pub(crate) fn new(path: &Path, companions: &[PathBuf], force: bool) -> Result<Self, Failure> {
        let output = Output { path: path.to_owned(), force: Cell::new(force) };
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
        self.temporary_file().map_err(|error| self.cannot_write(&error))
    }

    /// The same, with the error of the system.
    pub(crate) fn temporary_file(&self) -> io::Result<NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The rights of any new file, less the umask; a temporary file has rights for its user only.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        let file = builder.tempfile_in(self.folder())?;
        // The lock says to other processes that this file is in use; a file system without locks has none.
        let _ = file.as_file().lock_shared();
        self.remove_abandoned();
        Ok(file)
    }

    /// Removes the temporary files of processes that were killed: nobody holds a lock on them.
    fn remove_abandoned(&self) {
        let Ok(entries) = std::fs::read_dir(self.folder()) else { return };
        for entry in entries.flatten() {
            let name = entry.file_name();
            let name = name.to_string_lossy();
            let is_old = || entry.metadata().ok()?.modified().ok()?.elapsed().ok().map(|age| age > YOUNG);
            if !(name.starts_with(PREFIX) && name.ends_with(SUFFIX) && is_old().unwrap_or(false)) {
                continue;
            }
            // Without a lock to be had, the file may belong to anyone, and stays.
            if File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }

    /// Renames a finished file to the output.
    pub(crate) fn put(&self, file: NamedTempFile) -> Result<(), Failure> {
        self.put_as(file, &self.path)?;
        self.force.set(true);
        Ok(())
    }

    /// Renames a finished file to a companion of the output.
    pub(crate) fn put_as(&self, file: NamedTempFile, path: &Path) -> Result<(), Failure> {
        // A name must not reach the disk before the bytes do: after a power cut the file would be empty.
        file.as_file().sync_all().map_err(|error| self.cannot_write(&error))?;
        let outcome = if self.force.get() { file.persist(path) } else { file.persist_noclobber(path) };
        match outcome {
            Ok(_) => {
                self.sync_folder();
                Ok(())
            }
            // Another program made the file in the meantime.
            Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => Err(exists(path)),
            Err(failed) => Err(self.cannot_write(&failed.error)),
        }
    }

    /// Brings the new name to the disk. A file system that cannot do so keeps the file all the same.
    fn sync_folder(&self) {
        #[cfg(unix)]
        if let Ok(folder) = File::open(self.folder()) {
            let _ = folder.sync_all();
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
