//! Constraints that act only while they must: contacts that open and close, and what breaks.
//!
//! A contact holds C ≥ 0 with λ ≥ 0, one of the two zero; with friction it has one row for each direction along the surface. The
//! rows are always there, and evaluated; which of them take part in A λ = b is its mode:
//!
//! ```text
//! open       none                 λ = 0, C ≥ 0
//! smooth     normal               C = 0, λ ≥ 0, no friction
//! sticking   normal, tangents     no slip, |λ_t| ≤ μ λ_n
//! sliding    normal               λ_t = −μ λ_n (direction of slip), an applied force that follows λ_n
//! ```
//!
//! Between two events no mode changes, and the motion is as smooth as with equations alone. `integrate/events/` finds the time of
//! each event, `impact.rs` the jump of the velocity, `complementarity.rs` the modes that go on.
//! Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts (1996).

mod complementarity;
mod cones;
mod event_functions;
mod events;
mod impact;
mod lemke;
mod resolution;
mod start;

pub(crate) use complementarity::NoConsistentModes;
use complementarity::{Touching, settle};
pub(crate) use event_functions::{EventCause, Normals, first_violated, write_event_functions};
pub(crate) use events::write_events;
use impact::{collide, hold, shock};
pub(crate) use resolution::{EventResolution, RestThresholds, TOUCH_DISTANCE, rest_speed};
pub(crate) use start::{close, deepest};

#[cfg(test)]
mod tests;

/// The cosine above which two directions of slip are one: 0.03 rad.
const SAME_WAY: f64 = 0.9995;
