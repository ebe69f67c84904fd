//! Checks of the numbers and points that a user gave, and the errors that say why one is refused.

mod geometry;

pub use geometry::GeometryError;

use thiserror::Error;

/// The reason for which a number of a user is refused. `what` names the number.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ValueError {
    /// The number is infinite or not a number.
    #[error("{what} must be a finite number, not {value}")]
    NotFinite {
        /// The name of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The number is below zero.
    #[error("{what} must not be negative, but is {value}")]
    Negative {
        /// The name of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The number is not above zero, or not finite.
    #[error("{what} must be positive and finite, but is {value}")]
    NotPositive {
        /// The name of the number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The restitution is not in [0, 1].
    #[error("a restitution must lie between 0 (no bounce) and 1 (nothing lost), but is {value}")]
    Restitution {
        /// The restitution.
        value: f64,
    },
    /// A driven number depends on positions or velocities.
    #[error("{what} may depend on nothing but t, but `{expression}` names particles")]
    NamesParticles {
        /// The name of the number.
        what: &'static str,
        /// The text of the expression.
        expression: String,
    },
    /// A vector is too short or too long to give a direction.
    #[error("{what} must not be zero, nor too long or short to square")]
    NoDirection {
        /// The name of the vector.
        what: &'static str,
    },
}

/// `Ok` if the number is finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<(), ValueError> {
    if value.is_finite() { Ok(()) } else { Err(ValueError::NotFinite { what, value }) }
}

/// `Ok` if every component is finite.
pub(crate) fn all_finite(what: &'static str, vector: &[f64]) -> Result<(), ValueError> {
    vector.iter().try_for_each(|&component| finite(what, component))
}

/// `Ok` if the number is finite and not negative.
pub(crate) fn not_negative(what: &'static str, value: f64) -> Result<(), ValueError> {
    finite(what, value)?;
    if value >= 0.0 { Ok(()) } else { Err(ValueError::Negative { what, value }) }
}

/// `Ok` if the number is finite and above zero.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<(), ValueError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(ValueError::NotPositive { what, value }) }
}

/// `Ok` if e is in [0, 1].
pub(crate) fn check_restitution(value: f64) -> Result<(), ValueError> {
    if (0.0..=1.0).contains(&value) { Ok(()) } else { Err(ValueError::Restitution { value }) }
}

/// `Ok` if the impulse that breaks a link is positive and finite, or there is none.
pub(crate) fn check_impulse(breaks_at: Option<f64>) -> Result<(), ValueError> {
    breaks_at.map_or(Ok(()), |impulse| positive("the impulse at which something breaks", impulse))
}

/// `Ok` if the tension that breaks a link is positive and finite, or there is none.
pub(crate) fn check_strength(breaks_at: Option<f64>) -> Result<(), ValueError> {
    breaks_at.map_or(Ok(()), |tension| positive("the tension at which something breaks", tension))
}
