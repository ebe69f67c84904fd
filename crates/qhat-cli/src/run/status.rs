//! How a run ended, in one word.

use serde::Serialize;
use std::fmt;

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
