//! Pictures of [`qhat`]: the shapes of a system, and stills of a system as SVG or PNG.
//!
//! [`shapes`] lists one shape for everything that can be drawn: rods, ropes, springs, nails, surfaces, curves, wheels.
//! A shape names the particles that it is attached to and gives points of the scene. It contains no colours and no
//! pixels, so that any front end can draw it. [`svg`] is such a front end: it draws a still with a title, a legend and
//! a scale bar. With the feature `png`, the function `png` turns the still into a PNG, without fonts or programs of the
//! machine.
//!
//! ```
//! use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
//! use qhat_shapes::{Options, Picture, Reading, ShapeKind, shapes, svg};
//!
//! let mut builder = System::builder(Dimension::Two);
//! let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
//! let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(2.0));
//! builder.with_constraint("rod", Distance::new(hook, bob, 1.0)).force(Gravity { acceleration: [0.0, -9.81, 0.0] });
//! let (system, state) = builder.build()?;
//! assert_eq!(shapes(&system, &state)[0].kind, ShapeKind::Rod);
//!
//! let mut simulation = Simulation::new(system, state, Settings::default())?;
//! simulation.step()?;
//! let reading = Reading::of(&mut simulation);
//! let still = svg(&Picture::new(&simulation, &reading, "A hanging bob"), &Options::default());
//! assert!(still.starts_with("<svg") && still.contains("A hanging bob"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod constraint;
mod force;
mod gears;
mod list;
mod picture;
#[cfg(feature = "png")]
mod png;
mod shape;
#[cfg(test)]
mod tests;

pub use list::{driven_shapes, shapes};
pub use picture::{Options, Picture, Reading, svg};
#[cfg(feature = "png")]
pub use png::{PngError, png};
pub use shape::{Shape, ShapeKind, Source};
