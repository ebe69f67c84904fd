//! Constraints C(q) = 0, one kind a file, and the rows they make together.
//!
//! To add a kind: write one file here that derives C, Ċ, J and γ in its head and implements `Holds`, and name it in the
//! list below.

mod distance;
mod nail;
mod rows;

pub use distance::{Distance, DistanceForm};
pub use nail::{Nail, NailForm};
pub use rows::Jacobian;
pub(crate) use rows::{Layout, RowWriter, Rows};

use crate::point::Motion;
use crate::system::ParticleId;

/// What every constraint answers. [C] is the unit of its residual.
pub(crate) trait Holds {
    /// Number of scalar rows in d dimensions.
    fn row_count(&self, dimension: usize) -> usize;

    /// The particles its rows touch, in the order of the blocks that `evaluate` writes.
    fn particles(&self) -> Vec<ParticleId>;

    /// Writes C, Ċ, γ and the blocks of J, one row after the other.
    fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>);

    /// The |C| that counts as a relative error of one [C]; `extent` is the length scale of the system [m].
    fn scale(&self, extent: f64) -> f64;

    /// A bound on the norm of one block of ∂²C/∂q² [C/m²]: times |λ| it is geometric stiffness.
    fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// The same constraint in the forms of another formulation.
    fn formulated(&self, formulation: Formulation) -> Self;

    /// What is wrong with its numbers, in words.
    fn check(&self) -> Result<(), String>;
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
            fn particles(&self) -> Vec<ParticleId> {
                match self { $(Constraint::$kind(constraint) => constraint.particles(),)* }
            }
            fn evaluate<const D: usize>(&self, motion: Motion<'_, D>, rows: &mut RowWriter<'_, D>) {
                match self { $(Constraint::$kind(constraint) => constraint.evaluate(motion, rows),)* }
            }
            fn scale(&self, extent: f64) -> f64 {
                match self { $(Constraint::$kind(constraint) => constraint.scale(extent),)* }
            }
            fn curvature<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
                match self { $(Constraint::$kind(constraint) => constraint.curvature(motion),)* }
            }
            fn formulated(&self, formulation: Formulation) -> Self {
                match self { $(Constraint::$kind(constraint) => constraint.formulated(formulation).into(),)* }
            }
            fn check(&self) -> Result<(), String> {
                match self { $(Constraint::$kind(constraint) => constraint.check(),)* }
            }
        }
    };
}

constraints! {
    /// Two particles at a fixed distance: a rod.
    Distance,
    /// One particle at a fixed point.
    Nail,
}
