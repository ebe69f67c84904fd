//! Constraints C(q, t) = 0, one kind a file, and the rows they make together.
//!
//! To add a kind: write one file here that derives C, Ċ, J, γ, C_t and ∂²C/∂q² in its head and implements `Holds`, and name it in the
//! list below.

mod anchor;
mod angle;
mod area;
mod arms;
mod barrier;
mod curve;
mod direction;
mod distance;
mod expression;
mod gears;
mod lengths;
mod limits;
mod link;
mod moment;
mod nail;
mod on_circle;
mod on_curve;
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
pub use barrier::{Barrier, Surface};
pub use curve::Curve;
pub use direction::Direction;
pub use distance::{Distance, DistanceForm};
pub use expression::ExpressionConstraint;
pub use gears::Gears;
pub use lengths::Lengths;
pub use limits::Limits;
pub use link::Link;
pub use nail::{Nail, NailForm};
pub use on_circle::OnCircle;
pub use on_curve::OnCurve;
pub use on_line::{Line, OnLine};
pub use on_plane::{OnPlane, Plane};
pub use on_sphere::OnSphere;
pub use relation::Relation;
pub use rows::Jacobian;
pub(crate) use rows::{Layout, RowWriter, Rows};
pub use volume::Volume;

use crate::force::Force;
use crate::point::Motion;
use crate::stiffness::Stiffness;
use crate::system::{Dimension, ParticleId, in_dimension};
use std::ops::Range;

/// What every constraint answers. [C] is the unit of its residual.
pub(crate) trait Holds {
    /// Number of scalar rows in d dimensions.
    fn row_count(&self, dimension: usize) -> usize;

    /// Whether its rows are the components of a vector, x, y and z, and not several scalars.
    fn is_vector(&self) -> bool {
        false
    }

    /// The particles its rows touch, each once, in the order of the blocks that `evaluate` writes.
    fn particles(&self) -> Vec<ParticleId>;

    /// Writes C, Ċ, γ, C_t and the blocks of J, one row after the other.
    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>);

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// How far its rows give way.
    fn softness(&self) -> Softness {
        Softness::default()
    }

    /// What rows that give way are to a method that does not solve at the end of the step.
    fn as_force(&self) -> Option<Force> {
        None
    }

    /// A bound on the norm of one block of ∂²C/∂q² [C/m²]: times |λ| it is geometric stiffness.
    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `visit(i, j, block)`, i ≤ j counting its particles, with the geometric stiffness −Σ λ ∂²C/∂q² for the
    /// multipliers of its rows [N/m]; not where it is zero.
    fn geometric_stiffness<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        lambda: &[f64],
        visit: &mut impl FnMut(usize, usize, Stiffness<D>),
    );

    /// Whether the gradient of a row vanishes on one of its particles only where it vanishes on all: then the row can be
    /// eliminated together with any of them.
    fn pulls_on_each(&self) -> bool {
        false
    }

    /// Which of its rows open and close.
    fn contacts(&self, _dimension: usize) -> Vec<ContactRows> {
        Vec::new()
    }

    /// The tension or thrust that its first row does not survive [N].
    fn breaks_at(&self) -> Option<f64> {
        None
    }

    /// The same constraint in the forms of another formulation.
    fn formulated(&self, formulation: Formulation) -> Self;

    /// Why it cannot be in d dimensions, in words.
    fn fits(&self, _dimension: usize) -> Result<(), String> {
        Ok(())
    }

    /// What is wrong with its numbers, in words.
    fn check(&self) -> Result<(), String>;
}

/// A row of a constraint that opens and closes, C ≥ 0 and λ ≥ 0, with its rows of friction; rows count from its first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactRows {
    pub(crate) normal: usize,
    pub(crate) tangents: Range<usize>,
    /// e.
    pub(crate) restitution: f64,
    /// μ.
    pub(crate) friction: f64,
}

/// Refuses any number of dimensions but one.
fn only_in(wanted: usize, dimension: usize) -> Result<(), String> {
    if wanted == dimension {
        Ok(())
    } else {
        Err(format!("it is written for {wanted} dimensions, but the system has {dimension}"))
    }
}

fn check_restitution(restitution: f64) -> Result<(), String> {
    if (0.0..=1.0).contains(&restitution) {
        Ok(())
    } else {
        Err(format!("a restitution must lie between 0 (no bounce) and 1 (nothing lost), but is {restitution}"))
    }
}

fn check_strength(breaks_at: Option<f64>) -> Result<(), String> {
    match breaks_at {
        Some(limit) if !(limit.is_finite() && limit > 0.0) => {
            Err(format!("the tension at which something breaks must be positive and finite, but is {limit}"))
        }
        _ => Ok(()),
    }
}

/// How far a row gives way: C + α λ + α c Ċ = 0. [α] = m/N, [c] = N·s/m for a rod.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Softness {
    /// α ≥ 0; zero is rigid.
    pub(crate) compliance: f64,
    /// c ≥ 0, of a damper beside the compliance.
    pub(crate) damping: f64,
}

impl Softness {
    pub(crate) fn is_rigid(&self) -> bool {
        self.compliance == 0.0
    }

    /// 1 + α c/h: how much faster C must follow where its rate is C/h.
    #[inline(always)]
    pub(crate) fn lag(&self, h: f64) -> f64 {
        1.0 + self.compliance * self.damping / h
    }
}

/// Which forms of the constraints are in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Formulation {
    /// Length of rods and vector nails: well conditioned wherever the constraint holds.
    Modern,
    /// The source's own: squared distances and scalar nails, whose gradient vanishes exactly where they must hold.
    Classic,
}

macro_rules! constraints {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// Any constraint; one variant a kind.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Constraint { $($(#[$doc])* $kind($kind),)* }

        $(impl From<$kind> for Constraint {
            fn from(constraint: $kind) -> Self { Constraint::$kind(constraint) }
        })*

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
                match self { $(Constraint::$kind(constraint) => constraint.geometric_stiffness(motion, lambda, visit),)* }
            }
            fn pulls_on_each(&self) -> bool {
                match self { $(Constraint::$kind(constraint) => constraint.pulls_on_each(),)* }
            }
            fn contacts(&self, dimension: usize) -> Vec<ContactRows> {
                match self { $(Constraint::$kind(constraint) => constraint.contacts(dimension),)* }
            }
            fn breaks_at(&self) -> Option<f64> {
                match self { $(Constraint::$kind(constraint) => constraint.breaks_at(),)* }
            }
            fn formulated(&self, formulation: Formulation) -> Self {
                match self { $(Constraint::$kind(constraint) => constraint.formulated(formulation).into(),)* }
            }
            fn fits(&self, dimension: usize) -> Result<(), String> {
                match self { $(Constraint::$kind(constraint) => constraint.fits(dimension),)* }
            }
            fn check(&self) -> Result<(), String> {
                match self { $(Constraint::$kind(constraint) => constraint.check(),)* }
            }
        }
    };
}

impl Constraint {
    /// A rod: large systems are made of them, and what asks for one alone need not go through every kind.
    pub(crate) fn as_rod(&self) -> Option<&Distance> {
        if let Constraint::Distance(rod) = self { Some(rod) } else { None }
    }

    /// C at t = 0 with the particles at q [m], flat, d numbers each: what a constraint made for 0 would have to be made for, to hold there.
    ///
    /// # Panics
    /// Where q lacks a particle that it names.
    pub fn residual(&self, dimension: Dimension, positions: &[f64]) -> Vec<f64> {
        let d = dimension.number();
        let mut rows = Rows::new(Layout::new(std::iter::once(self), d), d, positions.len() / d);
        // C depends on no velocity: any will do.
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
    Barrier,
    /// An expression that stays zero.
    ExpressionConstraint,
    /// A linear relation between the places of particles.
    Relation,
    /// A weighted sum of distances: a rope over pulleys, lengths in a ratio.
    Lengths,
    /// The angle from one arm to another, or a motor.
    Angle,
    /// Wheels, racks and pinions that mesh.
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
    /// A particle at a distance from a point or another particle that may be driven.
    OnSphere,
    /// A particle on a circle in space.
    OnCircle,
    /// A particle on a smooth curve: a bead on a wire.
    OnCurve,
}
