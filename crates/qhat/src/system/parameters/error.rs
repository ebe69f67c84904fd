//! The reasons for which parameters are not bound.

use crate::constraint::ConstraintError;
use crate::expression::{ExpressionError, ParameterError};
use crate::force::ForceError;
use crate::settings::SettingsError;
use crate::system::ParticleError;
use thiserror::Error;

/// The reason for which parameters are not bound. The system stays as it was.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BindError {
    /// There are more or fewer values than parameters.
    #[error("{} for {}: give one value for each parameter", counted(*given, "value"), counted(*wanted, "parameter"))]
    Count {
        /// The number of parameters.
        wanted: usize,
        /// The number of values.
        given: usize,
    },
    /// A value is infinite or not a number.
    #[error("the parameter `{name}` must be a finite number, but is {value}")]
    NotFinite {
        /// The parameter.
        name: String,
        /// The value.
        value: f64,
    },
    /// A value is out of the range of its parameter.
    #[error("the parameter `{name}` must be {}, but is {value}", between(*least, *greatest))]
    OutOfRange {
        /// The parameter.
        name: String,
        /// The value.
        value: f64,
        /// The least value.
        least: f64,
        /// The greatest value.
        greatest: f64,
    },
    /// The structure depends on a number that would change.
    #[error("`{place}` cannot be changed in a system that is built: build the system anew")]
    Structure {
        /// The place of the number.
        place: String,
    },
    /// A part of the system does not take a number.
    #[error("`{place}` would be {value}: {reason}")]
    Refused {
        /// The place of the number.
        place: String,
        /// The number.
        value: f64,
        /// The reason.
        #[source]
        reason: Refused,
    },
    /// A part has no number under this key.
    #[error("`{place}` is no number that a parameter can give")]
    NoQuantity {
        /// The place of the number.
        place: String,
    },
    /// The name cannot be that of a parameter, or belongs to another one.
    #[error(transparent)]
    Name(#[from] ParameterError),
    /// The text is no expression of parameters.
    #[error("`{text}`: {reason}")]
    Text {
        /// The text.
        text: String,
        /// The reason.
        #[source]
        reason: ExpressionError,
    },
}

/// The reason for which a part of a system does not take a number.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Refused {
    /// A particle refuses it.
    #[error(transparent)]
    Particle(#[from] ParticleError),
    /// A constraint refuses it.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// A force refuses it.
    #[error(transparent)]
    Force(#[from] ForceError),
    /// The feedback refuses it.
    #[error(transparent)]
    Feedback(#[from] SettingsError),
}

fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}

/// A range in words.
fn between(least: f64, greatest: f64) -> String {
    match (least.is_finite(), greatest.is_finite()) {
        (true, true) => format!("at least {least} and at most {greatest}"),
        (true, false) => format!("at least {least}"),
        _ => format!("at most {greatest}"),
    }
}
