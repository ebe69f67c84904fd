//! **qhat**: exact constrained particle dynamics.
//!
//! Particles at q move under applied forces Q and constraints C(q, t) = 0. Each evaluation finds the multipliers λ of
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ      J = ∂C/∂q,  γ = J̇q̇,  W = M⁻¹
//! Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```
//!
//! and with them the constraint force Q̂ that cancels the illegal part of Q. `ks`, `kd` are feedback, ε is the diagonal drag
//! and s = 1 − elasticity: the two "stability menus" of the program this engine descends from. The default integrator needs
//! none of them.
//!
//! ```
//! use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
//!
//! let mut builder = System::builder(Dimension::Two);
//! let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
//! let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(2.0));
//! builder.constraint("rod", Distance::new(pivot, bob, 1.0));
//! builder.force(Gravity { acceleration: [0.0, -9.81, 0.0] });
//! let (system, state) = builder.build()?;
//!
//! let mut simulation = Simulation::new(system, state, Settings::default())?;
//! simulation.step()?;
//! assert!((simulation.tension()[0] - 2.0 * 9.81).abs() < 1e-9); // N: it hangs at rest
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Two pure doors, [`evaluate`] and [`step`], and one easy one, [`Simulation`]. Everything is f64 in SI units; vectors are
//! flat, particle after particle (x1 y1 x2 y2 …). No files, no network, no printing; the same input gives the same bits on
//! every target.

// The letters of the derivations are the letters of the code: Q, W, C, J, A and λ keep their case.
#![allow(non_snake_case)]

pub mod constraint;
pub mod expression;
pub mod force;
pub mod linalg;

mod allowed;
mod body;
mod chains;
mod cluster;
mod contact;
mod drift;
mod driven;
mod energy;
mod ensemble;
mod error;
mod integrate;
mod modes;
mod multiplier;
mod number;
mod point;
mod report;
mod settings;
mod simulation;
mod softness;
mod space;
mod state;
mod stiffness;
mod structure;
mod system;
mod terms;
mod threads;

pub use allowed::{GeometryError, ValueError};
pub use body::{Body, BodyError};
pub use cluster::rigid_rods;
pub use constraint::{
    Anchor, Angle, Area, Constraint, ConstraintError, Curve, Direction, Distance, DistanceForm, DrivenPoint,
    ExpressionConstraint, Formulation, Gears, Jacobian, Lengths, Limits, Line, Link, Nail, NailForm, NamedConstraint,
    Obstacle, OnCircle, OnCurve, OnLine, OnPlane, OnSphere, Plane, Relation, Rope, Strut, Surface, Volume,
};
pub use driven::Driven;
pub use energy::Energy;
pub use ensemble::step_all;
pub use error::StepError;
pub use expression::{Expression, ExpressionError, ParameterError, Purpose, Scope};
pub use force::{
    Actuator, AirDrag, CentralForce, CubicSpring, Drag, ExpressionForce, ExpressionPotential, Facet, Force, ForceError,
    Gas, Gravity, HarmonicForce, InverseSquare, MouseSpring, PointForce, Pressure, Spring, TorsionSpring,
};
pub use integrate::{Workspace, check_start, project, step};
pub use linalg::{Component, ComponentKind, FactorMethod, SymmetricMatrix};
pub use point::Vector;
pub use report::{Event, EventKind, Projection, Solver, StepReport, Warning};
pub use settings::{Feedback, Integrator, Settings, SettingsError};
pub use simulation::Simulation;
pub use softness::SoftRow;
pub use space::{ConstraintId, Dimension, ForceId, ParticleId};
pub use state::{State, Work};
pub use system::{BuildError, Particle, ParticleError, System, SystemBuilder};
pub use terms::{NOTATION, Notation, Terms, evaluate};
