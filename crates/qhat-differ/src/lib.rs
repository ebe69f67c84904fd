//! qhat beside a dense reference that was written apart from it, on random frameworks: a differential test.
//!
//! A seed gives a [`Framework`]. Its text goes to qhat through the reader of scenes; its [formulas](formula) go to the
//! [`Reference`], which shares no code with the engine: other derivatives, other linear algebra, another integrator.
//! [`compare`](compare::compare) sets forces, motions, residuals and energies beside each other. docs/testing.md says
//! what that covers and what it found.

pub mod compare;
pub mod dense;
pub mod formula;
pub mod framework;
pub mod generate;
pub mod hostile;
pub mod motion;
pub mod random;
pub mod reference;
pub mod seeds;
pub mod write;

pub use framework::Framework;
pub use reference::Reference;
