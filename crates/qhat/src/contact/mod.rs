//! Contacts: constraints that act on one side only, and constraints that break.
//!
//! A contact holds C ≥ 0 with λ ≥ 0, one of the two zero; with friction it has one more row for each direction along
//! the surface. The rows are always there, and evaluated; the mode of the contact says which of them are active in A
//! λ = b:
//!
//! ```text
//! mode       active rows          conditions
//! open       none                 λ = 0, C ≥ 0
//! smooth     normal               C = 0, λ ≥ 0, no friction
//! sticking   normal, tangents     no slip, |λ_t| ≤ μ λ_n
//! sliding    normal               λ_t = −μ λ_n (direction of slip), an applied force that follows λ_n
//! ```
//!
//! Between two events no mode changes, and the motion is as smooth as with equations alone. `event_functions.rs` says
//! what is watched, `integrate/events/` finds the time of an event, `resolution.rs` decides how it goes on:
//! `blows.rs` which contacts a blow strikes and which links it breaks, `impact.rs` the jump of the velocity,
//! `complementarity.rs` the next modes, `following.rs` the contacts that close because they follow from others.
//! `changes.rs` reports it.
//!
//! `complementarity.rs` asks `contradictions.rs` which modes are wrong, by the tolerances of `roundoff.rs`, and takes
//! modes from `pyramids.rs` and `lemke.rs` where that does not end. `start.rs` and `nearest.rs` are about the start.
//! Source: Pfeiffer, Glocker, Multibody Dynamics with Unilateral Contacts (1996).

mod blows;
mod changes;
mod complementarity;
mod contradictions;
mod event_functions;
mod following;
mod impact;
mod lemke;
mod nearest;
mod pyramids;
mod resolution;
mod rest;
mod roundoff;
mod start;

pub(crate) use complementarity::{NoConsistentModes, along, size};
use complementarity::{Touching, settle};
pub(crate) use event_functions::{EventCause, EventFunctions, Normals, first_violated};
use impact::{Impact, hold};
pub(crate) use nearest::NearestStart;
pub(crate) use resolution::EventResolution;
pub(crate) use rest::{RestThresholds, TOUCH_DISTANCE, rest_speed};
pub(crate) use start::{close, deepest};

#[cfg(test)]
mod tests;

/// Cosine of the angle up to which two directions of slip count as one: 0.03 rad.
const SAME_WAY: f64 = 0.9995;
