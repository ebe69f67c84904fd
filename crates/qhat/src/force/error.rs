//! The reasons for which a force is refused.

use crate::allowed::ValueError;
use thiserror::Error;

/// The reason for which a force is refused, by the builder or while a simulation runs.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ForceError {
    /// Another force has the same name.
    #[error("the name is used twice")]
    NameTaken,
    /// The force names a particle that does not exist.
    #[error("there is no particle number {particle}")]
    NoParticle {
        /// The number of the particle.
        particle: usize,
    },
    /// The system has no force with this id.
    #[error("there is no force number {force}")]
    NoForce {
        /// The number of the force.
        force: usize,
    },
    /// The force is written for another number of dimensions.
    #[error("it is written for {wanted} dimensions, but the system has {dimension}")]
    Dimension {
        /// The number of dimensions that it needs.
        wanted: usize,
        /// d of the system.
        dimension: usize,
    },
    /// A number is out of range.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// Both ends are the same particle.
    #[error("{what} needs two different particles")]
    SameEnds {
        /// The kind of the force.
        what: &'static str,
    },
    /// One particle is named twice.
    #[error("{what} needs different particles, but one is named twice")]
    NamedTwice {
        /// The kind of the force.
        what: &'static str,
    },
    /// A custom force names no particle.
    #[error("a custom force names no particle, so that it pulls nothing")]
    CustomWithoutParticles,
    /// Two of the three particles of a torsion spring are the same.
    #[error("a torsion spring needs three different particles")]
    TorsionParticles,
    /// The rest angle of a torsion spring is more than half a turn.
    #[error("the rest angle of a torsion spring must be within π of zero, but is {angle}")]
    RestAngle {
        /// The angle \[rad\].
        angle: f64,
    },
    /// Two corners of a facet are the same particle.
    #[error("a facet under pressure needs different particles at its corners")]
    FacetCorners,
    /// The gas fills no area or volume at the start.
    #[error("a gas must fill more than nothing at the start, but fills {content}")]
    GasContent {
        /// The area \[m²\] or volume \[m³\].
        content: f64,
    },
    /// Too many particles hold a gas.
    #[error("a gas may have at most {most} particles, but has {count}")]
    GasParticles {
        /// The largest number of particles.
        most: usize,
        /// The number of particles.
        count: usize,
    },
    /// The components of a force are written for another number of dimensions than there are components.
    #[error("a force has an expression for each dimension; {count} are given, but one is written for {written}")]
    Components {
        /// The number of components.
        count: usize,
        /// The number of dimensions that one of them is written for.
        written: usize,
    },
    /// A potential depends on velocities.
    #[error("a potential may depend on positions and time only, not on velocities")]
    DependsOnVelocities,
    /// A potential depends on no particle.
    #[error("the potential depends on no particle, so that it pulls nothing")]
    DependsOnNothing,
    /// The hand takes hold of a fixed particle.
    #[error("`{particle}` is fixed, so that no force moves it")]
    Fixed {
        /// The name of the particle.
        particle: String,
    },
    /// The hand moves, but holds no particle.
    #[error("no particle is grabbed, so that there is nothing to drag")]
    NothingGrabbed,
}
