//! Runs the built command as a user does, in a folder of its own.

pub(crate) mod npz;

use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// The built command.
pub(crate) const QHAT: &str = env!("CARGO_BIN_EXE_qhat");

/// A bob on a rod, held by a nail; the bob falls from the horizontal.
pub(crate) const PENDULUM: &str = r#"
schema = "qhat/1"
name = "A bob"
dimension = 2
step = { h = 0.01, duration = 0.5 }
forces = { gravity = [0.0, -9.81] }
particles = [{ id = "hook", at = [0.0, 0.0], fixed = true }, { id = "bob", at = [1.0, 0.0], mass = 2.0 }]
constraints = [{ kind = "distance", between = ["hook", "bob"] }]
"#;

/// A point one metre from each of two others that are five metres apart.
pub(crate) const INFEASIBLE: &str = r#"
schema = "qhat/1"
name = "Torn"
dimension = 2
particles = [
    { id = "a", at = [0.0, 0.0], fixed = true },
    { id = "b", at = [5.0, 0.0], fixed = true },
    { id = "c", at = [1.0, 0.5] },
]
constraints = [
    { kind = "distance", between = ["a", "c"], length = 1.0 },
    { kind = "distance", between = ["b", "c"], length = 1.0 },
]
"#;

/// A pendulum released from the horizontal. Its rod carries 3 m g sin φ at the angle φ below the horizontal, and breaks
/// at 2 m g.
pub(crate) const BREAKS: &str = r#"
schema = "qhat/1"
name = "Breaks"
dimension = 2
step = { h = 0.01, duration = 0.6, tolerance = 1e-9 }
forces = { gravity = [0.0, -10.0] }
particles = [{ id = "hook", at = [0.0, 0.0], fixed = true }, { id = "bob", at = [1.0, 0.0] }]
constraints = [{ kind = "distance", id = "arm", between = ["hook", "bob"], breaks_at = 20.0 }]
"#;

/// A ball that falls 0.2 m to the length of its rope, in 0.2 s; the impulse breaks the rope.
pub(crate) const JERKED: &str = r#"
schema = "qhat/1"
name = "Jerked"
dimension = 2
step = { h = 0.01, duration = 0.5 }
forces = { gravity = [0.0, -10.0] }
particles = [{ id = "hook", at = [0.0, 1.0], fixed = true }, { id = "ball", at = [0.0, 0.2] }]
constraints = [{ kind = "rope", between = ["hook", "ball"], length = 1.0, breaks_at_impulse = 1.0 }]
"#;

/// A folder to work in, which is removed at the end of the test.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Folder(TempDir::new().unwrap())
    }

    /// A folder with these files.
    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let folder = Folder::new();
        for (name, text) in files {
            std::fs::write(folder.path(name), text).unwrap();
        }
        folder
    }

    pub(crate) fn root(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.root().join(name)
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.root()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs the command here.
    pub(crate) fn qhat(&self, arguments: &[&str]) -> Ran {
        self.qhat_reading("", arguments)
    }

    /// Runs the command with a text on stdin.
    pub(crate) fn qhat_reading(&self, stdin: &str, arguments: &[&str]) -> Ran {
        let mut command = Command::new(QHAT);
        command.current_dir(self.root()).args(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child.stdin.take().unwrap().write_all(stdin.as_bytes()).unwrap();
        Ran::new(child.wait_with_output().unwrap())
    }
}

/// The exit code and the output of a command.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Ran {
    pub(crate) fn new(output: Output) -> Self {
        Ran {
            code: output.status.code().expect("no signal ends it"),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// This outcome, after a check that the exit code is 0 and stderr is empty.
    #[track_caller]
    pub(crate) fn well(self) -> Self {
        assert_eq!((self.code, self.stderr.as_str()), (0, ""), "{}", self.stdout);
        self
    }

    /// This outcome, after a check that the input was refused with a message that contains these words, without a
    /// panic.
    #[track_caller]
    pub(crate) fn refused(self, words: &str) -> Self {
        assert_eq!(self.code, 2, "{self:?}");
        assert!(self.stderr.contains(words), "{}", self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    /// The output on stdout, as JSON.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}
