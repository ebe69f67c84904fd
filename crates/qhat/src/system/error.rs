//! The reasons for which a system cannot be built.

use super::parameters::BindError;
use crate::constraint::ConstraintError;
use crate::force::ForceError;
use crate::settings::SettingsError;
use thiserror::Error;

/// The reason for which a system cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// A particle is refused.
    #[error("particle `{name}`: {reason}")]
    Particle {
        /// Its name.
        name: String,
        /// The reason for which it is refused.
        #[source]
        reason: ParticleError,
    },
    /// A constraint is refused.
    #[error("constraint `{name}`: {reason}")]
    Constraint {
        /// Its name.
        name: String,
        /// The reason for which it is refused.
        #[source]
        reason: ConstraintError,
    },
    /// A force is refused.
    #[error("force {}: {reason}", name.as_ref().map_or(format!("number {index}"), |name| format!("`{name}`")))]
    Force {
        /// Its name, if it has one.
        name: Option<String>,
        /// Its place in the order of addition, from 0.
        index: usize,
        /// The reason for which it is refused.
        #[source]
        reason: ForceError,
    },
    /// The factor of A would not fit.
    #[error(
        "the {rows} rows that hang together with constraint `{constraint}` are so closely connected that their factor \
         would take {} GiB of memory; the limit is {} GiB",
        memory.div_ceil(1 << 30), limit >> 30
    )]
    TooLarge {
        /// The first constraint of the largest connected part.
        constraint: String,
        /// The number of its rows.
        rows: usize,
        /// The memory that it would take \[bytes\].
        memory: u64,
        /// The memory that is allowed \[bytes\].
        limit: u64,
    },
    /// A parameter is out of range, or gives a number that its part refuses.
    #[error(transparent)]
    Parameters(#[from] BindError),
    /// A feedback coefficient is out of range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

/// The reason for which a particle is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParticleError {
    /// Another particle has the same name.
    #[error("the name is used twice")]
    NameTaken,
    /// The position or the velocity has the wrong number of components.
    #[error("the {what} must have {dimension} components, but has {count}")]
    Components {
        /// The word `position` or `velocity`.
        what: &'static str,
        /// d of the system.
        dimension: usize,
        /// The number of components.
        count: usize,
    },
    /// A component of the position or velocity is infinite or not a number.
    #[error("position and velocity must be finite numbers")]
    NotFinite,
    /// The mass, or its inverse, is not positive and finite.
    #[error("the mass must be positive and finite, but is {mass:?} kg")]
    Mass {
        /// m \[kg\].
        mass: f64,
    },
    /// A fixed particle has a velocity.
    #[error("a fixed particle cannot have a velocity")]
    FixedWithVelocity,
}
