//! A failure of the command: its message and its exit code.

use qhat_bench::{RunError, UnknownWorkload};
use qhat_scene::fitted;
use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

/// Exit code: the motion diverged, or the constraints cannot hold.
pub(crate) const NOT_REACHED: u8 = 1;
/// Exit code: the scene, an option or a file is at fault; a full disk, too.
pub(crate) const BAD_INPUT: u8 = 2;
/// Exit code: ended by Ctrl-C, 128 + SIGINT, by the convention of shells; SIGTERM and SIGHUP have the same code.
pub(crate) const INTERRUPTED: u8 = 130;

/// A message for a person and an exit code for a script.
#[derive(Debug)]
pub(crate) struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// A mistake in a scene, an option or a file.
    pub(crate) fn input(message: impl Display) -> Self {
        Failure { message: format!("error: {message}"), code: BAD_INPUT }
    }

    /// A message that names its place already, as the errors of scenes do.
    pub(crate) fn formatted(message: impl Display) -> Self {
        Failure { message: message.to_string(), code: BAD_INPUT }
    }

    /// An error of a file or stream. `what` names the file and the operation.
    pub(crate) fn io(what: impl Display, error: &io::Error) -> Self {
        Failure::input(format!("{what}: {error}"))
    }

    /// The message, without the word `error`.
    pub(crate) fn message(&self) -> &str {
        self.message.strip_prefix("error: ").unwrap_or(&self.message)
    }

    /// Prints the message on stderr and returns the exit code.
    pub(crate) fn report(self) -> ExitCode {
        warn(self.message.trim_end());
        ExitCode::from(self.code)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Failure::input(error)
    }
}

impl From<UnknownWorkload> for Failure {
    fn from(error: UnknownWorkload) -> Self {
        Failure::input(error)
    }
}

/// Prints a line on stderr. A closed stderr is ignored.
pub(crate) fn warn(line: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{}", fitted(&line.to_string()));
}
