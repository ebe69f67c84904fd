//! The reasons for which a step was not taken. Each error reads as a sentence with the names that a user gave.

use crate::settings::{Integrator, SettingsError};
use thiserror::Error;

/// The reason for which a step was not taken. The state is the last good one.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// A coordinate or velocity became infinite or undefined.
    #[error(
        "at t = {} s the motion of `{particle}` is no longer a finite number: the step h is too large for \
         this system",
        shown(*time)
    )]
    NotFinite {
        /// t of the last good state \[s\].
        time: f64,
        /// The first particle concerned.
        particle: String,
    },
    /// A constraint is violated beyond recognition.
    #[error(
        "at t = {} s the constraint `{row}` is off by {relative:.0} times its own size: the step h is too \
         large, or the constraints cannot all hold",
        shown(*time)
    )]
    Diverged {
        /// t of the last good state \[s\].
        time: f64,
        /// The worst row.
        row: String,
        /// |C| relative to the row's scale.
        relative: f64,
    },
    /// No forces or impulses were found that fit all contacts.
    #[error(
        "at t = {} s no contact forces fit: what `{constraint}` does contradicts the others (friction of \
         this size may have no answer; lower it)",
        shown(*time)
    )]
    Jammed {
        /// t of the last good state \[s\].
        time: f64,
        /// One of the contacts.
        constraint: String,
    },
    /// A frame had so many events that it may have no end of them.
    #[error(
        "at t = {} s one frame has had {events} events, contacts that open and close; a shorter h, or less \
         restitution, may do",
        shown(*time)
    )]
    TooManyEvents {
        /// t of the last good state \[s\].
        time: f64,
        /// The number of events.
        events: usize,
    },
    /// The system has events, and the integrator cannot locate them.
    #[error("`{constraint}` opens, closes or breaks, and {integrator} cannot find when: use auto, dop853 or dopri5")]
    NoEvents {
        /// The integrator that was chosen.
        integrator: Integrator,
        /// The first constraint that has events.
        constraint: String,
    },
    /// The start is beyond what a contact or limit allows. Nothing says on which side it belongs, so it is not moved.
    #[error(
        "at t = {} s {} beyond what `{constraint}` allows: start elsewhere, or change it",
        shown(*time), beyond(particles, *depth)
    )]
    Penetrates {
        /// t \[s\].
        time: f64,
        /// The constraint that is violated most.
        constraint: String,
        /// The particles that it names.
        particles: Vec<String>,
        /// The depth of C below zero \[m\].
        depth: f64,
    },
    /// No positions that satisfy the constraints were found nearby.
    #[error(
        "at t = {} s no positions near by satisfy the constraints: `{row}` is still off by {residual:e}. Compare its \
         numbers with the positions, and with the constraints beside it",
        shown(*time)
    )]
    NotSatisfied {
        /// t of the last good state \[s\].
        time: f64,
        /// The worst row of the best try.
        row: String,
        /// Its |C| \[C\].
        residual: f64,
    },
    /// The frame would need more substeps than allowed.
    #[error(
        "at t = {} s the frame needs more than {max_substeps} substeps: raise max_substeps or the tolerance, or use \
         auto",
        shown(*time)
    )]
    TooManySubsteps {
        /// t of the last good state \[s\].
        time: f64,
        /// The limit in force.
        max_substeps: usize,
    },
    /// Constraints or forces of very many particles, under a method that solves for the end of the step.
    #[error(
        "at t = {} s implicit methods would need a block for each of {pairs} pairs of particles, of which {limit} are \
         allowed{}: use dop853",
        shown(*time), most_at(constraint.as_deref())
    )]
    TooManyCouplings {
        /// t of the last good state \[s\].
        time: f64,
        /// The constraint with most particles; `None` where forces alone couple the particles.
        constraint: Option<String>,
        /// The number of pairs of particles that constraints and forces couple.
        pairs: usize,
        /// The number that is allowed.
        limit: usize,
    },
    /// The factors of the method would not fit into memory.
    #[error(
        "the particles are so many and so closely coupled that {integrator} would need more than 1 GiB for its \
         factors: use auto, dop853 or bdf2"
    )]
    TooCoupled {
        /// The integrator that was chosen.
        integrator: Integrator,
    },
    /// A setting was refused.
    #[error(transparent)]
    Settings(#[from] SettingsError),
}

/// The constraint that couples most pairs, in words.
fn most_at(constraint: Option<&str>) -> String {
    constraint.map_or(String::new(), |name| format!(" (constraint `{name}` couples most)"))
}

/// The names of particles, and how far they are beyond a surface or limit.
fn beyond(particles: &[String], depth: f64) -> String {
    let names: Vec<String> = particles.iter().map(|name| format!("`{name}`")).collect();
    let verb = if names.len() == 1 { "is" } else { "are" };
    // A depth that rounds to zero is shown with an exponent.
    let depth = if depth < 1e-6 { format!("{depth:.1e}") } else { shown(depth).to_string() };
    format!("{} {verb} {depth} m", names.join(" and "))
}

/// A time as a person reads it: to the nanosecond, without the roundoff of the sums it came from.
fn shown(time: f64) -> f64 {
    (time * 1e9).round() / 1e9
}
