//! The reasons for which a constraint is refused.

use crate::allowed::{GeometryError, ValueError};
use thiserror::Error;

/// The reason for which a constraint is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ConstraintError {
    /// Another constraint has the same name.
    #[error("the name is used twice")]
    NameTaken,
    /// The constraint names a particle that does not exist.
    #[error("there is no particle number {particle}")]
    NoParticle {
        /// The number of the particle.
        particle: usize,
    },
    /// The constraint exists in another number of dimensions only.
    #[error("it is written for {wanted} dimensions, but the system has {dimension}")]
    Dimension {
        /// The number of dimensions that it needs.
        wanted: usize,
        /// d of the system.
        dimension: usize,
    },
    /// A circle with an axis is in the plane.
    #[error("a circle with an axis needs three dimensions; in two dimensions, use a sphere")]
    CircleInPlane,
    /// A plane that holds a particle is in the plane.
    #[error("a plane needs three dimensions; in two dimensions, hold the particle on a line")]
    PlaneInPlane,
    /// A number is out of range.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// The curve does not fit the system.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// Both ends are the same particle.
    #[error("{what} needs two different particles")]
    SameEnds {
        /// The kind of the constraint.
        what: &'static str,
    },
    /// One particle is named twice.
    #[error("{what} needs different particles, but one is named twice")]
    NamedTwice {
        /// The kind of the constraint.
        what: &'static str,
    },
    /// A compliance whose inverse, the stiffness, is infinite.
    #[error("a compliance of {compliance:e} m/N is too small to divide by; 0 is rigid")]
    ComplianceTooSmall {
        /// α [m/N].
        compliance: f64,
    },
    /// A rod with a compliance is in the squared form.
    #[error("a rod with a compliance must be held in the length form")]
    ComplianceInSquaredForm,
    /// A rod has both a compliance and an impulse at which it breaks.
    #[error("a rod with a compliance gives way to a blow, so that no impulse breaks it: give `breaks_at`, a tension")]
    ComplianceTakesNoBlow,
    /// A rope or strut has no limit.
    #[error("give the shortest length, the longest, or both")]
    NoLimits,
    /// The longest length is not more than the shortest.
    #[error(
        "the longest length must be more than the shortest, but {longest} m is not more than {shortest} m; \
         a rod holds one length"
    )]
    LimitsCrossed {
        /// L₀ \[m\].
        shortest: f64,
        /// L₁ \[m\].
        longest: f64,
    },
    /// A relation has no particle.
    #[error("a relation needs particles")]
    NoTerms,
    /// A particle of a relation has the weight 0.
    #[error("a weight of 0 says nothing; leave the particle out")]
    NoWeight {
        /// The place of the term.
        term: usize,
    },
    /// A particle of a relation has two weights.
    #[error("each particle can have one weight; add them up")]
    TwoWeights {
        /// The place of the second term.
        term: usize,
    },
    /// A rope over pulleys has no segment.
    #[error("a rope goes over two points at least")]
    NoSegments,
    /// A segment of a weighted sum of lengths has the weight 0.
    #[error("a segment of weight 0 says nothing; leave it out")]
    NoSegmentWeight {
        /// The place of the segment.
        segment: usize,
    },
    /// Both ends of a segment are the same particle.
    #[error("a segment goes from one particle to another")]
    SegmentEnds {
        /// The place of the segment.
        segment: usize,
    },
    /// A sum of lengths with positive weights is to be zero or less.
    #[error("the length of a rope must be above 0, but is {length} m")]
    RopeLength {
        /// The length at the start \[m\].
        length: f64,
    },
    /// Both ends of an arm are the same particle.
    #[error("an arm goes from one particle to another")]
    ArmEnds {
        /// The place of the arm.
        arm: usize,
    },
    /// The direction from which an angle counts is zero.
    #[error("a direction needs a length")]
    NoDirection,
    /// A gear has fewer than two arms.
    #[error("a gear couples two arms at least")]
    GearArms,
    /// An arm of a gear has no length.
    #[error("an arm of a gear goes from its centre to another particle, and wheels that mesh have two centres")]
    GearArmEnds {
        /// The place of the arm.
        arm: usize,
    },
    /// A wheel has too many teeth.
    #[error("divided by their common factor, the numbers of teeth may be at most {most}")]
    GearTeeth {
        /// The largest number of teeth.
        most: u32,
    },
    /// A wheel has no teeth.
    #[error("a wheel without teeth does not mesh; leave it out")]
    GearWithoutTeeth {
        /// The place of its arm.
        arm: usize,
    },
    /// A polygon has fewer than three corners.
    #[error("a polygon has three corners or more, not {count}")]
    PolygonCorners {
        /// The number of corners.
        count: usize,
    },
    /// A particle is two corners of one polygon.
    #[error("a particle can be one corner of a polygon only")]
    PolygonCornerTwice {
        /// The place of the second corner.
        corner: usize,
    },
    /// Two corners of a face are one particle.
    #[error("a face has three different corners")]
    FaceCorners {
        /// The place of the face.
        face: usize,
    },
    /// Two faces pass one side in the same direction.
    #[error("two faces run along one side in the same direction: turn one of them round")]
    FaceTurned {
        /// The place of the second face.
        face: usize,
    },
    /// A side of the surface has a face on one side only.
    #[error("the surface is not closed: each side needs a face on either side of it")]
    NotClosed,
    /// A custom constraint names no particle.
    #[error("a custom constraint names no particle, so that nothing could hold it at zero")]
    CustomWithoutParticles,
    /// The residual depends on velocities.
    #[error("a constraint may depend on positions and time only, not on velocities")]
    DependsOnVelocities,
    /// The residual depends on no particle.
    #[error("the residual depends on no particle, so that nothing could hold it at zero")]
    DependsOnNothing,
    /// The residual or one of its derivatives is infinite or undefined at the start.
    #[error("the residual or a derivative of it is not a finite number at the start")]
    NotFiniteAtStart,
    /// The scale of a residual is not above zero, or not finite.
    #[error("the scale of a residual must be above 0 and finite, but is {scale}")]
    Scale {
        /// The scale \[C\].
        scale: f64,
    },
    /// The residual does not change with positions at the start, so its scale cannot be measured there.
    #[error("no position changes the residual at the start, so that its scale must be given")]
    NeedsScale,
}

/// `Ok` if the number of dimensions is the one that a constraint needs.
pub(super) fn only_in(wanted: usize, dimension: usize) -> Result<(), ConstraintError> {
    if wanted == dimension { Ok(()) } else { Err(ConstraintError::Dimension { wanted, dimension }) }
}
