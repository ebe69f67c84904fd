//! The reasons for which a step was not taken. Each error reads as a sentence with the names that a user gave.

use crate::constraint::CurveEnd;
use crate::settings::{Integrator, SettingsError};
use crate::system::BindError;
use crate::words::{Digits, Seconds};
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
    /// C of a row is not continuous.
    #[error(
        "at t = {} s the residual of `{row}` jumps to {residual:.2e}: a function in it is not continuous there (an \
         angle that passes its branch, a sign, a remainder); write it so that it goes on",
        shown(*time)
    )]
    Jumps {
        /// t of the last good state \[s\].
        time: f64,
        /// The row.
        row: String,
        /// C beyond the jump.
        residual: f64,
    },
    /// Ċ of a row is not continuous.
    #[error(
        "at t = {} s the rate of `{row}` jumps: its residual would leave zero at {} a second. A function in it has a \
         kink there; write it so that its slope goes on",
        shown(*time), Digits(rate.abs())
    )]
    RateJumps {
        /// t of the last good state \[s\].
        time: f64,
        /// The row.
        row: String,
        /// Ċ beyond the jump \[C/s\].
        rate: f64,
    },
    /// No multipliers satisfy the equation of motion to three digits.
    #[error(
        "at t = {} s the constraint forces cannot be found to three digits: masses, lengths or forces are too many \
         decades apart, or constraints nearly depend on each other",
        shown(*time)
    )]
    OutOfBalance {
        /// t of the last good state \[s\].
        time: f64,
    },
    /// Parameters are not bound.
    #[error(transparent)]
    Parameters(#[from] BindError),
    /// The kinetic or potential energy is infinite or undefined: its numbers are beyond what can be computed with.
    #[error(
        "at t = {} s the {energy} energy of `{particle}` is not a finite number: a position, a velocity, a mass or a \
         force there is too large to compute with",
        shown(*time)
    )]
    EnergyNotFinite {
        /// t of the last good state \[s\].
        time: f64,
        /// `kinetic` or `potential`.
        energy: &'static str,
        /// The particle with the largest part in it.
        particle: String,
    },
    /// The motion changes faster than the shortest substep follows, although the constraints hold.
    #[error(
        "at t = {} s the motion of `{particle}` runs away: its acceleration is {} m/s², and no substep is short \
         enough to follow it. A force that grows without bound does this",
        shown(*time), Digits(*acceleration)
    )]
    RanAway {
        /// t of the last good state \[s\].
        time: f64,
        /// The particle with the largest acceleration under the applied forces.
        particle: String,
        /// That acceleration [m/s²].
        acceleration: f64,
    },
    /// Coordinates are so large that their roundoff hides the motion.
    #[error(
        "at t = {} s `{particle}` is {} m from the origin, where roundoff leaves {} m of a step uncertain: \
         {integrator} cannot tell forces from it. Put the origin near the system, or take a longer h",
        shown(*time), Digits(*distance), Digits(*roundoff)
    )]
    TooFarOut {
        /// t of the last good state \[s\].
        time: f64,
        /// The particle that is farthest out.
        particle: String,
        /// Its distance from the origin \[m\].
        distance: f64,
        /// The roundoff of a step there \[m\].
        roundoff: f64,
        /// The integrator that cannot go on.
        integrator: Integrator,
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
        "at t = {} s no positions near by satisfy the constraints: `{row}` is still off by {}, in m or the \
         unit of its condition. Compare its numbers with the positions, and with the constraints beside it",
        shown(*time), Digits(residual.abs())
    )]
    NotSatisfied {
        /// t of the last good state \[s\].
        time: f64,
        /// The worst row of the best try.
        row: String,
        /// Its C \[C\].
        residual: f64,
    },
    /// A drive asks for what the other constraints do not allow.
    #[error(
        "at t = {} s the drive `{drive}` asks for more than the other constraints allow: `{row}` is off by {}, \
         and no positions near by satisfy them all",
        shown(*time), Digits(residual.abs())
    )]
    DriveBlocked {
        /// t of the last good state \[s\].
        time: f64,
        /// The drive.
        drive: String,
        /// The worst row of the best try.
        row: String,
        /// Its C \[C\].
        residual: f64,
    },
    /// A drive comes to a place where the other constraints do not follow it any more.
    #[error(
        "at t = {} s the drive `{drive}` asks for more than the other constraints allow: no substep is short enough to \
         follow it, although the constraints hold up to there. It has come to the end of its linkage",
        shown(*time)
    )]
    DriveEnds {
        /// t of the last good state \[s\].
        time: f64,
        /// The drive.
        drive: String,
    },
    /// No velocities satisfy the constraints at the start.
    #[error("at t = {} s {}", shown(*time), rate_left(row, *rate, drive.as_deref()))]
    RateNotSatisfied {
        /// t \[s\].
        time: f64,
        /// The worst row.
        row: String,
        /// Its Ċ \[C/s\].
        rate: f64,
        /// The drive that asks for it, if one does.
        drive: Option<String>,
    },
    /// A dead centre: the constraints do not say on which of two branches the motion goes on.
    #[error(
        "at t = {} s the constraints do not decide which way to go: this is a dead centre of the drive `{drive}`, \
         which more than one motion follows. Start a little beside the dead centre, or with a velocity that decides",
        shown(*time)
    )]
    Undecided {
        /// t \[s\].
        time: f64,
        /// The drive.
        drive: String,
    },
    /// A bead has come to the end of its curve.
    #[error("at t = {} s {}", shown(*time), at_the_end(particle, constraint, *end))]
    CurveEnds {
        /// t of the last good state \[s\].
        time: f64,
        /// The bead.
        particle: String,
        /// The constraint that holds it on the curve.
        constraint: String,
        /// The end.
        end: CurveEnd,
    },
    /// The gradient of a constraint is not defined where the motion leads: a stretch of a rope, a rod of driven length
    /// or an arm of an angle has shrunk to nothing, or an expression has a kink there.
    #[error("at t = {} s {}", shown(*time), without_gradient(constraint, ends))]
    NoGradient {
        /// t \[s\] of the last good state, or at which a driven length comes to nothing.
        time: f64,
        /// The constraint.
        constraint: String,
        /// The ends of the stretch without length, or its one particle where the other end is a point; empty where the
        /// constraint has no stretches.
        ends: Vec<String>,
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

impl StepError {
    /// Whether constraints were not met, which another method might still do.
    pub(crate) fn is_unmet(&self) -> bool {
        use StepError::{DriveBlocked, DriveEnds, NotSatisfied};
        matches!(self, NotSatisfied { .. } | DriveBlocked { .. } | DriveEnds { .. })
    }
}

fn rate_left(row: &str, rate: f64, drive: Option<&str>) -> String {
    let cause = match drive {
        Some(drive) => format!("the drive `{drive}` asks for velocities that the other constraints do not allow"),
        None => "no velocities satisfy the constraints".to_owned(),
    };
    format!("{cause}: the residual of `{row}` would leave zero at {} a second", Digits(rate.abs()))
}

fn at_the_end(particle: &str, constraint: &str, end: CurveEnd) -> String {
    let point = match end {
        CurveEnd::First => "first",
        CurveEnd::Last => "last",
        CurveEnd::Undefined => {
            return format!("`{particle}` comes to a place on `{constraint}` beyond which the path has no value");
        }
    };
    format!(
        "`{particle}` comes to the {point} point of `{constraint}`, and the curve ends there: give the curve more \
         points, or close it"
    )
}

fn without_gradient(constraint: &str, ends: &[String]) -> String {
    match ends {
        [] => format!(
            "the gradient of `{constraint}` jumps or has no value, as that of |x| at x = 0, so that its force is not \
             defined there: write it in a form that is smooth, or keep the motion away from there"
        ),
        [end] => format!(
            "`{constraint}` leaves `{end}` no distance from its centre, so that its force has no direction there: keep \
             its size above zero"
        ),
        [a, b, ..] => format!(
            "`{constraint}` has no length left between `{a}` and `{b}`, so that its force has no direction there: keep \
             them apart"
        ),
    }
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
    let depth = if depth < 1e-6 { format!("{depth:.1e}") } else { ((depth * 1e9).round() / 1e9).to_string() };
    format!("{} {verb} {depth} m", names.join(" and "))
}

/// A time as a person reads it [s].
fn shown(time: f64) -> Seconds {
    Seconds(time)
}
