//! Acceptance: the one place that decides whether a substep of a method with an error estimate is kept.
//!
//! A substep is kept if
//!
//! 1. every number of it is finite;
//! 2. its error estimate is at most `MISSED` tolerances;
//! 3. every |C| is at most what `drift::attainable` says: half the constraint tolerance, against the scale of the row
//!    and the extent of the system, which are fixed at the start;
//! 4. the projection onto C = 0 and Ċ = 0 moved q and q̇ by at most `MOVED` tolerances, in the norm of the estimate: a
//!    method that is right to the tolerance leaves no more to correct. A motion whose velocities were not projected
//!    before, near a singular position, may be moved further;
//! 5. its multipliers are in balance: A λ = b to the part `BALANCE` of b at every stage.
//!
//! A substep that is not kept is tried again with a shorter length. If the shortest is not kept either, the frame ends
//! with an error that names the culprit of the condition that failed. The projection of a start and impacts may move
//! the state further; they are no substeps.

use crate::settings::Settings;

/// Error of an accepted substep, in tolerances. The controller aims at the tolerance itself, and a substep that is a
/// little too long costs less than two.
const MISSED: f64 = 3.0;

/// Way of a projection, in tolerances. The estimate is a mean with a safety of its own, so most projections move by
/// less than one tolerance; the constraint tolerance, which may have gathered over many substeps, is allowed as well.
const MOVED: f64 = 10.0;

/// Relative residual of A λ = b. A load of a billion beads leaves 1e-7 by rounding alone.
pub(crate) const BALANCE: f64 = 1e-3;

/// The condition that a substep failed, besides its error estimate and C = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// The projection moved the state too far: C jumps.
    Jump,
    /// The multipliers do not satisfy the equation.
    Balance,
    /// The substep passes a place beyond which the motion is another one (`integrate/edges.rs`).
    Edge,
}

/// Whether a substep with this error estimate is kept; an error that is not a number is not.
pub(crate) fn accepts(error: f64, settings: &Settings) -> bool {
    error <= MISSED * settings.tolerance
}

/// Whether a projection may move a motion by this much, relative to the extent and to the fastest speed like the error
/// estimate.
pub(crate) fn accepts_move(moved: f64, settings: &Settings) -> bool {
    moved <= MOVED * settings.tolerance.max(settings.constraint_tolerance)
}
