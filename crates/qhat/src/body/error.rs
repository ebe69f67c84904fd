//! The reasons for which a body is refused.

use thiserror::Error;

/// The reason for which a body is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BodyError {
    /// A mass that is not positive and finite \[kg\].
    #[error("the mass of a body must be positive and finite, but is {0} kg")]
    Mass(f64),
    /// A coordinate or moment that is not finite.
    #[error("the numbers of a body must be finite")]
    NotFinite,
    /// Too few or too many edges.
    #[error("a body has one edge (a bar), two (a plate) or three (a block), not {0}")]
    EdgeCount(usize),
    /// Edges without length, along one line, or in one plane.
    #[error("the edges of a body must have a length, and must not lie in one line, or all three in one plane")]
    FlatEdges,
    /// Particles that rounding puts at the same place, or out of range.
    #[error("the particles of a body must be at different places, as far as numbers of that size can tell")]
    Lost,
    /// A tensor whose two halves differ.
    #[error("an inertia tensor is symmetric")]
    NotSymmetric,
    /// Moments that break the triangle inequality.
    #[error(
        "no body has this inertia: none of its principal moments may be negative, or above the sum of the other two"
    )]
    Inertia,
    /// Moments that are all zero.
    #[error("a body without a moment of inertia is a particle")]
    NoExtent,
}
