//! How a run ended.

use crate::failure::{INTERRUPTED, NOT_REACHED};
use qhat::StepError;
use serde::Serialize;
use std::fmt;
use std::process::ExitCode;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Status {
    /// It reached its end.
    Done,
    /// The motion became infinite, left its constraints, or needed ever smaller steps.
    Diverged,
    /// No positions near by satisfy the constraints.
    Infeasible,
    /// Someone pressed Ctrl-C.
    Interrupted,
}

impl Status {
    /// How a run ended that a step could not go on with.
    pub(crate) fn of(error: &StepError) -> Self {
        match error {
            StepError::NotSatisfied { .. } | StepError::Penetrates { .. } => Status::Infeasible,
            _ => Status::Diverged,
        }
    }

    /// What the command tells scripts.
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
