//! Applied forces: Q = Σ of every force acting on every particle [N], and the energy each of them stores or takes.
//!
//! To add a force: write one file here with `add`, `potential`, `power`, `stiffness` and `tangent`, and name it in the list below.

mod actuator;
mod air_drag;
mod central;
mod cubic_spring;
mod drag;
mod expression;
mod gas;
mod gravity;
mod harmonic;
mod inverse_square;
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
pub use drag::Drag;
pub use expression::{ExpressionForce, ExpressionPotential};
pub use gas::Gas;
pub use gravity::Gravity;
pub use harmonic::HarmonicForce;
pub use inverse_square::InverseSquare;
pub use mouse::MouseSpring;
pub use point_force::PointForce;
pub use pressure::{Facet, Pressure};
pub use spring::Spring;
pub use torsion::TorsionSpring;

use crate::point::Motion;
use crate::stiffness::Stiffness;
use crate::system::ParticleId;

/// What every force answers. `mass` is [kg], one per particle.
pub(crate) trait Acts {
    /// Adds this force to Q.
    fn add<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64], Q: &mut [f64]);

    /// Potential energy [J]; zero for a force that has none.
    fn potential<const D: usize>(&self, motion: Motion<'_, D>, mass: &[f64]) -> f64;

    /// Power of the part that no potential accounts for [W]; negative where energy is taken.
    fn power<const D: usize>(&self, motion: Motion<'_, D>) -> f64;

    /// Calls `bound(particle, stiffness [N/m], damping [N·s/m])` with a bound on the row sums of −∂Q/∂q and −∂Q/∂q̇:
    /// what limits the step of an explicit method.
    fn stiffness<const D: usize>(&self, motion: Motion<'_, D>, bound: &mut impl FnMut(ParticleId, f64, f64));

    /// What it changes with, while nothing but the motion goes on.
    fn dependence(&self) -> Dependence;

    /// Calls `visit(i, j, block)` with −∂Q/∂q − rate ∂Q/∂q̇ [N/m], for a method that solves at the end of the step, where q̇
    /// follows q at `rate` [1/s]. Any two particles that it couples must be among those it names.
    fn tangent<const D: usize>(
        &self,
        motion: Motion<'_, D>,
        rate: f64,
        visit: &mut impl FnMut(ParticleId, ParticleId, Stiffness<D>),
    );

    /// The only number of dimensions it fits, if there is one.
    fn dimension(&self) -> Option<usize> {
        None
    }

    /// The particles this force names, each once; empty when it acts on all.
    fn particles(&self) -> Vec<ParticleId>;

    /// What is wrong with its numbers, in words.
    fn check(&self) -> Result<(), String>;
}

/// What a force changes with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Dependence {
    /// Nothing: it is the same at every motion.
    Nothing,
    /// −coefficient q̇ on every particle [N·s/m].
    Drag(f64),
    /// The positions and velocities of the particles it names, and the time.
    Motion,
}

macro_rules! forces {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// Any force; one variant a kind.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Force { $($(#[$doc])* $kind($kind),)* }

        $(impl From<$kind> for Force {
            fn from(force: $kind) -> Self { Force::$kind(force) }
        })*

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
            fn dimension(&self) -> Option<usize> {
                match self { $(Force::$kind(force) => force.dimension(),)* }
            }
            fn particles(&self) -> Vec<ParticleId> {
                match self { $(Force::$kind(force) => force.particles(),)* }
            }
            fn check(&self) -> Result<(), String> {
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
    /// A force on one particle, an expression for each component.
    ExpressionForce,
    /// A potential energy as an expression.
    ExpressionPotential,
    /// Inverse-square force between one particle and a point.
    CentralForce,
    /// Inverse-square force between two particles: gravity or electrostatics.
    InverseSquare,
    /// Linear and quadratic drag of one particle in air that may move.
    AirDrag,
    /// Force on one particle that swings with time.
    HarmonicForce,
    /// Push along the line between two particles, constant and swinging with time.
    Actuator,
    /// Spring between two particles with a cubic term.
    CubicSpring,
    /// Damped torsion spring at a hinge between two arms.
    TorsionSpring,
    /// Pressure on one edge of a closed loop or one triangle of a closed mesh.
    Pressure,
    /// A gas in a closed loop or mesh, whose pressure follows what it fills.
    Gas,
}

/// `Ok` if the number is finite; otherwise a sentence that names it.
pub(crate) fn finite(what: &str, value: f64) -> Result<(), String> {
    if value.is_finite() { Ok(()) } else { Err(format!("{what} must be a finite number, not {value}")) }
}

/// `Ok` if the number is finite and not negative; otherwise a sentence that names it.
pub(crate) fn not_negative(what: &str, value: f64) -> Result<(), String> {
    finite(what, value)?;
    if value >= 0.0 { Ok(()) } else { Err(format!("{what} must not be negative, but is {value}")) }
}
