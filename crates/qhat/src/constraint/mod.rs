//! Constraints C(q, t) = 0: one file for each kind, and the rows that all constraints make together.
//!
//! `docs/adding-a-constraint.md` adds a kind step by step.

mod anchor;
mod angle;
mod area;
mod arms;
mod curve;
mod custom;
mod direction;
mod distance;
mod error;
mod expression;
mod feet;
mod gears;
mod jacobian;
mod kind;
mod layout;
mod lengths;
mod limits;
mod link;
mod moment;
mod nail;
mod named;
mod obstacle;
mod on_circle;
mod on_curve;
mod on_ellipse;
mod on_line;
mod on_plane;
mod on_sphere;
mod polyline;
mod relation;
mod rows;
mod smooth;
mod spline;
#[cfg(test)]
mod tests;
mod volume;

pub use anchor::{Anchor, DrivenPoint};
pub use angle::Angle;
pub use area::Area;
pub use curve::{Curve, CurveEnd};
pub use custom::{Custom, CustomConstraint};
pub use direction::Direction;
pub use distance::{Distance, DistanceForm};
pub use error::ConstraintError;
pub use expression::ExpressionConstraint;
pub use gears::Gears;
pub use jacobian::Jacobian;
pub(crate) use jacobian::RowWriter;
pub use kind::Formulation;
pub(crate) use kind::{ContactRows, Holds, Softness};
pub(crate) use layout::Layout;
pub use lengths::Lengths;
pub use limits::{Limits, Rope, Strut};
pub use link::Link;
pub use nail::{Nail, NailForm};
pub use named::NamedConstraint;
pub use obstacle::{Obstacle, Surface};
pub use on_circle::OnCircle;
pub use on_curve::OnCurve;
pub use on_ellipse::OnEllipse;
pub use on_line::{Line, OnLine};
pub use on_plane::{OnPlane, Plane};
pub use on_sphere::OnSphere;
pub use relation::Relation;
pub(crate) use rows::Rows;
pub use volume::Volume;

use crate::force::Force;
use crate::point::Motion;
use crate::space::{Dimension, ParticleId, in_dimension};
use crate::stiffness::Stiffness;

macro_rules! constraints {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// Any constraint; one variant for each kind.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Constraint { $($(#[$doc])* $kind($kind),)* }

        $(impl From<$kind> for Constraint {
            fn from(constraint: $kind) -> Self { Constraint::$kind(constraint) }
        })*

        impl Constraint {
            /// The names of all kinds: those of the variants.
            pub const KINDS: &'static [&'static str] = &[$(stringify!($kind)),*];

            /// The name of its kind, one of [`Constraint::KINDS`].
            pub fn kind(&self) -> &'static str {
                match self { $(Constraint::$kind(_) => stringify!($kind),)* }
            }
        }

        impl Holds for Constraint {
            fn row_count(&self, dimension: usize) -> usize {
                match self { $(Constraint::$kind(constraint) => constraint.row_count(dimension),)* }
            }
            fn is_vector(&self) -> bool {
                match self { $(Constraint::$kind(constraint) => constraint.is_vector(),)* }
            }
            fn particles(&self) -> Vec<ParticleId> {
                match self { $(Constraint::$kind(constraint) => constraint.particles(),)* }
            }
            fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
                match self { $(Constraint::$kind(constraint) => constraint.evaluate(motion, rows),)* }
            }
            fn scale(&self, extent: f64) -> f64 {
                match self { $(Constraint::$kind(constraint) => constraint.scale(extent),)* }
            }
            fn softness(&self) -> Softness {
                match self { $(Constraint::$kind(constraint) => constraint.softness(),)* }
            }
            fn as_force(&self) -> Option<Force> {
                match self { $(Constraint::$kind(constraint) => constraint.as_force(),)* }
            }
            fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
                match self { $(Constraint::$kind(constraint) => constraint.curvature(motion),)* }
            }
            #[inline(always)]
            fn geometric_stiffness<const D: usize>(
                &self,
                motion: Motion<'_, D>,
                lambda: &[f64],
                visit: &mut impl FnMut(usize, usize, Stiffness<D>),
            ) {
                match self { $(Constraint::$kind(kind) => kind.geometric_stiffness(motion, lambda, visit),)* }
            }
            fn pulls_on_each(&self) -> bool {
                match self { $(Constraint::$kind(constraint) => constraint.pulls_on_each(),)* }
            }
            fn flexibility(&self, row: usize, t: f64) -> f64 {
                match self { $(Constraint::$kind(constraint) => constraint.flexibility(row, t),)* }
            }
            fn contacts(&self, dimension: usize) -> [Option<ContactRows>; 2] {
                match self { $(Constraint::$kind(constraint) => constraint.contacts(dimension),)* }
            }
            fn breaks_at(&self) -> Option<f64> {
                match self { $(Constraint::$kind(constraint) => constraint.breaks_at(),)* }
            }
            fn breaks_at_impulse(&self) -> Option<f64> {
                match self { $(Constraint::$kind(constraint) => constraint.breaks_at_impulse(),)* }
            }
            fn may_jump(&self) -> bool {
                match self { $(Constraint::$kind(constraint) => Holds::may_jump(constraint),)* }
            }
            fn arms(&self) -> Vec<[ParticleId; 2]> {
                match self { $(Constraint::$kind(constraint) => Holds::arms(constraint),)* }
            }
            fn least_size(&self, t: f64) -> f64 {
                match self { $(Constraint::$kind(constraint) => Holds::least_size(constraint, t),)* }
            }
            fn formulated(&self, formulation: Formulation) -> Self {
                match self { $(Constraint::$kind(constraint) => constraint.formulated(formulation).into(),)* }
            }
            fn fits(&self, dimension: usize) -> Result<(), ConstraintError> {
                match self { $(Constraint::$kind(constraint) => constraint.fits(dimension),)* }
            }
            fn check(&self) -> Result<(), ConstraintError> {
                match self { $(Constraint::$kind(constraint) => constraint.check(),)* }
            }
        }
    };
}

impl Constraint {
    /// The rod, if the constraint is a rod. Large systems are made of rods, and a caller that needs only rods saves the
    /// match over all kinds.
    pub(crate) fn as_rod(&self) -> Option<&Distance> {
        if let Constraint::Distance(rod) = self { Some(rod) } else { None }
    }

    /// C at t = 0 with the particles at q \[m\], flat, d numbers each. For a constraint made with the
    /// target 0, this is the target (length, angle, area) that the given positions satisfy.
    ///
    /// # Panics
    /// If q lacks a particle that the constraint names.
    pub fn residual(&self, dimension: Dimension, positions: &[f64]) -> Vec<f64> {
        let d = dimension.number();
        let mut rows = Rows::new(Layout::new(std::iter::once(self), d), d, positions.len() / d);
        // C depends on no velocity, so q serves as q̇.
        in_dimension!(dimension, D => {
            rows.evaluate(std::iter::once(self), Motion::<D> { q: positions, qd: positions, t: 0.0 });
        });
        rows.C
    }
}

constraints! {
    /// Two particles at a fixed distance: a rod.
    Distance,
    /// One particle at a fixed point.
    Nail,
    /// Two particles no nearer and no farther than limits: a rope, a strut.
    Limits,
    /// One particle on one side of a surface.
    Obstacle,
    /// An expression that is held at zero.
    ExpressionConstraint,
    /// A residual written in Rust that is held at zero.
    Custom,
    /// A linear relation between the positions of particles.
    Relation,
    /// A weighted sum of distances: a rope over pulleys, lengths in a ratio.
    Lengths,
    /// The angle from one arm to another, or a motor.
    Angle,
    /// Meshing wheels, racks and pinions.
    Gears,
    /// A polygon that keeps its area.
    Area,
    /// A closed surface that keeps its volume.
    Volume,
    /// Two particles whose connecting line has a given direction.
    Direction,
    /// A particle on a line.
    OnLine,
    /// A particle on a plane.
    OnPlane,
    /// A particle at a distance, which may be driven, from a point or another particle.
    OnSphere,
    /// A particle on a circle in space.
    OnCircle,
    /// A particle on an ellipse in the plane.
    OnEllipse,
    /// A particle on a smooth curve: a bead on a wire.
    OnCurve,
}
