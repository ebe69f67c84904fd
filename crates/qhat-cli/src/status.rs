//! The end of a run.

use crate::failure::{INTERRUPTED, NOT_REACHED};
use qhat::StepError;
use serde::Serialize;
use std::fmt;
use std::process::ExitCode;

/// The end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Status {
    /// The run reached its duration.
    Done,
    /// The motion became infinite, left its constraints, or needed ever smaller steps.
    Diverged,
    /// No positions or velocities near by satisfy the constraints, or the motion has come to an edge of them.
    Infeasible,
    /// A signal such as Ctrl-C ended the run, or frames could not be written.
    Interrupted,
}

impl Status {
    /// The end of a run whose step or start failed with this error.
    pub(crate) fn of(error: &StepError) -> Self {
        match error {
            StepError::NotSatisfied { .. }
            | StepError::Penetrates { .. }
            | StepError::DriveBlocked { .. }
            | StepError::DriveEnds { .. }
            | StepError::RateNotSatisfied { .. }
            | StepError::Undecided { .. }
            | StepError::CurveEnds { .. }
            | StepError::NoGradient { .. } => Status::Infeasible,
            _ => Status::Diverged,
        }
    }

    /// The exit code of the command, for scripts.
    pub(crate) fn exit_code(self) -> ExitCode {
        match self {
            Status::Done => ExitCode::SUCCESS,
            Status::Diverged | Status::Infeasible => ExitCode::from(NOT_REACHED),
            Status::Interrupted => ExitCode::from(INTERRUPTED),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Status::Done => "done",
            Status::Diverged => "diverged",
            Status::Infeasible => "infeasible",
            Status::Interrupted => "interrupted",
        })
    }
}
