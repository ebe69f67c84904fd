//! **qhat**: exact constrained particle dynamics. Rods do not stretch, loops stay closed, and the force in every
//! constraint is known.
//!
//! ```
//! use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
//!
//! // Model, hold, push.
//! let mut builder = System::builder(Dimension::Two);
//! let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
//! let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(2.0));
//! let rod = builder.constraint("rod", Distance::new(pivot, bob, 1.0));
//! builder.force(Gravity::new([0.0, -9.81]));
//! let (system, state) = builder.build()?;
//!
//! // Step.
//! let mut simulation = Simulation::new(system, state, Settings::default())?;
//! let report = simulation.step()?; // one frame of 0.01 s
//! assert!(report.max_relative_length_error < 1e-10);
//!
//! // Look.
//! let tension = simulation.tension_of(rod).unwrap();
//! assert!((tension - 2.0 * 9.81).abs() < 1e-9); // N: the bob hangs at rest
//! assert!((simulation.support(pivot)[1] + 2.0 * 9.81).abs() < 1e-9); // N, on the ground
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The five things one does
//!
//! **Model.** A [`System::builder`] collects [`Particle`]s, constraints and forces, and gives an id for each. [`Body`]
//! makes rigid bodies of particles and rods, [`rigid_cluster`] holds a cluster of particles together.
//!
//! **Hold.** A constraint keeps a function of the positions at zero, exactly:
//!
//! | held at its value | by |
//! |---|---|
//! | a distance | [`Distance`], [`Limits`] (a rope, a strut), [`Lengths`] (a rope over pulleys) |
//! | a place | [`Nail`], [`Relation`], [`OnLine`], [`OnPlane`], [`OnSphere`], [`OnCircle`], [`OnEllipse`], [`OnCurve`] |
//! | a direction or angle | [`Direction`], [`Angle`] (a motor), [`Gears`] |
//! | an area or a volume | [`Area`], [`Volume`] |
//! | a side of a surface | [`Obstacle`] with a [`Surface`], restitution and friction |
//! | a function of one's own | [`ExpressionConstraint`] from a text, [`Custom`] from a [`CustomConstraint`] in Rust |
//!
//! A number that is [`Driven`] follows a function of time: `Driven::text("2*pi*t")`.
//!
//! **Push.** Forces: [`Gravity`], [`Drag`], [`AirDrag`], [`Spring`], [`CubicSpring`], [`TorsionSpring`],
//! [`PointForce`], [`HarmonicForce`], [`Actuator`], [`CentralForce`], [`InverseSquare`], [`Pressure`], [`Gas`],
//! [`ExpressionForce`], [`ExpressionPotential`], [`CustomForce`] from a [`CustomPotential`] in Rust, and
//! [`MouseSpring`], the hand of [`Simulation::grab`].
//!
//! **Step.** [`Simulation::step`] and [`Simulation::advance`] go on by a frame. Their [`StepReport`] has the residuals
//! of the constraints, the [`Event`]s of the frame and its [`Warning`]s. [`Settings`] choose the [`Integrator`], the
//! frame and the tolerance. [`run_all`] and [`step_all`] run many simulations on every core. Below all this are two
//! functions whose results depend on their arguments alone, [`evaluate`] and [`step`].
//!
//! **Look.** [`Simulation::links`] for tensions, [`reaction`](Simulation::reaction) for the multipliers of a
//! constraint, [`support`](Simulation::support) for the force on the ground, [`energy`](Simulation::energy), and
//! [`Terms`] for every symbol of the equation. Between steps, [`Simulation::set_force`] changes a force, and
//! [`Simulation::grab`] takes hold of a particle.
//!
//! Everything is f64 in SI units. Vectors are flat, particle after particle (x1 y1 x2 y2 …); where a function takes one
//! vector, it takes `[f64; 2]` and `[f64; 3]` alike. No files, no network, no printing; the same input gives the same
//! bits on every target.
//!
//! # Words
//!
//! Most kinds have the same word in scene files (`direction`, `relation`, `area`, `volume`, `gears`). These differ:
//!
//! | scene | Rust |
//! |---|---|
//! | `kind = "distance"` | [`Distance::new`]; with a `length` of t [`Distance::driven`] |
//! | `rope`, `limits` | [`Rope::new`], [`Limits`] (with a shortest length alone [`Strut::new`]) |
//! | `nail` | [`Nail::new`]; at a point of t [`Nail::driven`] |
//! | `pulley`, `length-ratio` | [`Lengths::pulley`], [`Lengths::ratio`] |
//! | `coincidence`, `midpoint` | [`Relation::coincidence`], [`Relation::midpoint`] |
//! | `center-of-mass` | [`Relation::center_of_mass`] |
//! | `line`, `plane`, `sphere` | [`OnLine`], [`OnPlane`], [`OnSphere`] |
//! | `circle`, `ellipse`, `curve` | [`OnCircle`], [`OnEllipse`], [`OnCurve`] |
//! | `rigid` | [`rigid_cluster`], [`Distance`] and [`Relation`] |
//! | `half-space`, `ball`, `box` | [`Obstacle`] with a [`Surface`] |
//! | `rack` | [`Gears::rack`] |
//! | `expression` | [`ExpressionConstraint`] |
//! | `fixed = true` | [`Particle::fixed`] |
//! | `integrator = "implicit"` or `"backward-euler"` | [`Integrator::Implicit`] |
//! | `[forces] gravity`, `drag` | [`Gravity`], [`Drag`] |
//! | `[feedback] ks`, `kd`, `diagonal_drag`, `elasticity` | [`Feedback`] |
//!
//! # The equation
//!
//! Particles at q move under applied forces Q and constraints C(q, t) = 0. Each evaluation finds the multipliers λ of
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ      J = ∂C/∂q,  γ = J̇q̇,  W = M⁻¹
//! Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```
//!
//! and with them the constraint force Q̂ that cancels the part of Q that would break the constraints. `ks` and `kd` are
//! feedback, ε is the diagonal drag, and s = 1 − elasticity; integrators that project use none of them.
//!
//! # Debug builds
//!
//! The profile of a dependency does not count in the program that depends on it, so a debug build of your program
//! compiles qhat without optimisation. These eight lines in the `Cargo.toml` of your workspace make it as fast as a
//! release build:
//!
//! ```toml
//! [profile.dev.package.qhat]
//! opt-level = 3
//! codegen-units = 1
//! debug-assertions = false
//! overflow-checks = false
//!
//! [profile.dev.package."*"]
//! opt-level = 3
//! ```
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `rayon` | yes | threads; without it, the same bits on one |
//! | `serde` | no | `Serialize`, `Deserialize` for settings, reports, energies and ids; `Serialize` for terms |
//! | `mint` | no | points and vectors of other crates wherever a [`Vector`] goes |

// The letters of the derivations are the letters of the code: Q, W, C, J, A and λ keep their case.
#![allow(non_snake_case)]

pub mod expression;

mod allowed;
mod body;
mod chains;
mod cluster;
mod constraint;
mod contact;
mod drift;
mod driven;
mod energy;
mod ensemble;
mod error;
mod force;
mod hyper;
mod integrate;
mod linalg;
mod modes;
mod multiplier;
mod number;
mod point;
mod report;
#[cfg(feature = "serde")]
mod saved;
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
mod words;

pub use allowed::{GeometryError, ValueError};
pub use body::{Body, BodyError, Pose};
pub use cluster::{RigidCluster, rigid_cluster, rigid_rods};
#[doc(inline)]
pub use constraint::*;
pub use driven::Driven;
pub use energy::Energy;
pub use ensemble::{run_all, step_all};
pub use error::StepError;
pub use expression::{Expression, ExpressionError, ParameterError, Purpose, Scope};
pub use force::{
    Actuator, AirDrag, CentralForce, CubicSpring, CustomForce, CustomPotential, Drag, ExpressionForce,
    ExpressionPotential, Facet, Force, ForceError, Gas, Gravity, HarmonicForce, InverseSquare, MouseSpring, PointForce,
    Pressure, Spring, TorsionSpring,
};
pub use hyper::Hyper;
pub use integrate::{Workspace, check_start, project, step};
pub use linalg::{Component, ComponentKind, FactorMethod, SymmetricMatrix};
pub use multiplier::Freedom;
pub use number::larger;
pub use point::Vector;
pub use report::{Event, EventKind, MaxTension, Projection, RepeatedWarning, Solver, StepReport, Warning, WarningLog};
#[cfg(feature = "serde")]
pub use saved::RestoreError;
pub use settings::{Feedback, Integrator, Settings, SettingsError};
pub use simulation::{Powers, Simulation};
pub use softness::SoftRow;
pub use space::{ConstraintId, Dimension, ForceId, ParticleId};
pub use state::{State, Work};
pub use structure::FlatClique;
pub use system::{
    BindError, BuildError, Parameter, ParameterUse, Particle, ParticleError, Quantity, Refused, System, SystemBuilder,
};
pub use terms::{NOTATION, Notation, Terms, evaluate};
pub use words::{Digits, Seconds};
