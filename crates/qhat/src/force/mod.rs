//! Applied forces: Q is the sum of all forces on each particle [N]. Each force also gives the energy that it stores and
//! the power that it takes.
//!
//! To add a force, write one file here that implements `Acts`, and name it in the list below.

mod actuator;
mod air_drag;
mod central;
mod cubic_spring;
mod custom;
mod drag;
mod error;
mod expression;
mod gas;
mod gravity;
mod harmonic;
mod inverse_square;
mod kind;
mod line;
mod mouse;
mod point_force;
mod pressure;
mod spring;
#[cfg(test)]
mod tests;
mod torsion;

pub use actuator::Actuator;
pub use air_drag::AirDrag;
pub use central::CentralForce;
pub use cubic_spring::CubicSpring;
pub use custom::{CustomForce, CustomPotential};
pub use drag::Drag;
pub use error::ForceError;
pub use expression::{ExpressionForce, ExpressionPotential};
pub use gas::Gas;
pub use gravity::Gravity;
pub use harmonic::HarmonicForce;
pub use inverse_square::InverseSquare;
pub(crate) use kind::{Acts, Dependence};
pub use mouse::MouseSpring;
pub use point_force::PointForce;
pub use pressure::{Facet, Pressure};
pub use spring::Spring;
pub use torsion::TorsionSpring;

use crate::linalg::block::Block;
use crate::point::Motion;
use crate::space::ParticleId;
use crate::stiffness::Stiffness;

macro_rules! forces {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// Any force; one variant for each kind.
        #[derive(Clone, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Force { $($(#[$doc])* $kind($kind),)* }

        $(impl From<$kind> for Force {
            fn from(force: $kind) -> Self { Force::$kind(force) }
        })*

        impl Force {
            /// The names of all kinds: those of the variants.
            pub const KINDS: &'static [&'static str] = &[$(stringify!($kind)),*];

            /// The name of its kind, one of [`Force::KINDS`].
            pub fn kind(&self) -> &'static str {
                match self { $(Force::$kind(_) => stringify!($kind),)* }
            }
        }

        impl Acts for Force {
            fn add<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64], Q: &mut [f64]) {
                match self { $(Force::$kind(force) => force.add(motion, mass, Q),)* }
            }
            fn potential<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64]) -> f64 {
                match self { $(Force::$kind(force) => force.potential(motion, mass),)* }
            }
            fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64 {
                match self { $(Force::$kind(force) => force.power(motion),)* }
            }
            fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64)) {
                match self { $(Force::$kind(force) => force.stiffness(motion, bound),)* }
            }
            fn dependence(&self) -> Dependence {
                match self { $(Force::$kind(force) => force.dependence(),)* }
            }
            fn tangent<const D: usize>(
                &self,
                motion: Motion<'_, D>,
                rate: f64,
                visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
            ) {
                match self { $(Force::$kind(force) => force.tangent(motion, rate, visit),)* }
            }
            fn linearize<const D: usize>(
                &self,
                motion: Motion<'_, D>,
                visit: &mut impl FnMut(ParticleId, ParticleId, Block<D>, Block<D>),
            ) {
                match self { $(Force::$kind(force) => force.linearize(motion, visit),)* }
            }
            fn dimension(&self) -> Option<usize> {
                match self { $(Force::$kind(force) => force.dimension(),)* }
            }
            fn particles(&self) -> Vec<ParticleId> {
                match self { $(Force::$kind(force) => force.particles(),)* }
            }
            fn check(&self) -> Result<(), ForceError> {
                match self { $(Force::$kind(force) => force.check(),)* }
            }
        }
    };
}

forces! {
    /// Uniform gravity.
    Gravity,
    /// Viscous drag on every particle.
    Drag,
    /// Damped Hookean spring between two particles.
    Spring,
    /// Constant force on one particle.
    PointForce,
    /// Damped spring between one particle and a point that a hand moves.
    MouseSpring,
    /// A force on one particle, with an expression for each component.
    ExpressionForce,
    /// A potential energy as an expression.
    ExpressionPotential,
    /// A potential energy written in Rust.
    CustomForce,
    /// Inverse-square force between one particle and a point.
    CentralForce,
    /// Inverse-square force between two particles: gravity or electrostatics.
    InverseSquare,
    /// Linear and quadratic drag of one particle in air that may move.
    AirDrag,
    /// Force on one particle that oscillates with time.
    HarmonicForce,
    /// Push along the line between two particles, the sum of a constant and an oscillating part.
    Actuator,
    /// Spring between two particles with a cubic term.
    CubicSpring,
    /// Damped torsion spring at a hinge between two arms.
    TorsionSpring,
    /// Pressure on one edge of a closed loop or one triangle of a closed mesh.
    Pressure,
    /// A gas in a closed loop or mesh, whose pressure depends on the area or volume inside.
    Gas,
}
