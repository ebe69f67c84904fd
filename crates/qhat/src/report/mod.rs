//! Reports of steps: substeps, errors, events and warnings.

mod warning;

pub use warning::{RepeatedWarning, Warning, WarningLog};

use crate::drift::Drift;
use crate::energy::Energy;
use crate::point::larger;
use crate::settings::Integrator;
use crate::space::ConstraintId;
use std::fmt;

/// One frame or step in numbers. Maxima are over its substeps.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct StepReport {
    /// Substeps taken (1 for a step of a fixed-step integrator).
    pub substeps: usize,
    /// Substeps rejected and tried again, shorter.
    pub rejected: usize,
    /// Factorizations of A, or of the matrix of a step that is solved at its end. Open chains are factored in every
    /// solve; these do not count.
    pub factorizations: usize,
    /// Newton iterations on C(q) = 0, or on the equations of a step that is solved at its end.
    pub iterations: usize,
    /// The smallest substep \[s\].
    pub smallest_substep: f64,
    /// max |C| over the rigid rows \[C\].
    pub max_residual: f64,
    /// max |Ċ| over the rigid rows [C/s].
    pub max_residual_rate: f64,
    /// max ||d| − r|/r over the rigid rods.
    pub max_relative_length_error: f64,
    /// The largest tension or thrust of any link at the end of any substep; recorded where
    /// [`Simulation::record_tension`](crate::Simulation::record_tension) asks for it.
    pub max_tension: Option<MaxTension>,
    /// Energies at the end.
    pub energy: Energy,
    /// The integrator that advanced this frame; under `auto`, the one that it chose.
    pub integrator: Integrator,
    /// The path to the multipliers.
    pub solver: Solver,
    /// Contacts that opened, closed, slipped or stuck, and links that broke, in the order of time.
    pub events: Vec<Event>,
    /// Conditions that did not stop the step, and that a user should know of.
    pub warnings: Vec<Warning>,
}

/// An event: a constraint begins or ceases to act, or takes an impact.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Event {
    /// t \[s\].
    pub time: f64,
    /// The name of the constraint.
    pub constraint: String,
    /// The kind of the event.
    pub kind: EventKind,
    /// The impulse along the normal of an impact, or the impulse that broke the link \[N·s\]; 0 for all other events.
    pub impulse: f64,
}

/// The kind of an event of a constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum EventKind {
    /// An impact with a closing speed above the rest speed.
    Impact {
        /// The speed at which it closed in [m/s].
        speed: f64,
    },
    /// The constraint acts from now on: a rope went taut, a particle came to rest on the ground.
    Closed,
    /// The constraint no longer acts.
    Opened,
    /// A contact that stuck begins to slip.
    Slipped,
    /// A contact that slipped sticks.
    Stuck,
    /// The link broke, for good.
    Broke,
}

/// The largest tension or thrust of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct MaxTension {
    /// The tension \[N\], negative if it is a thrust.
    pub tension: f64,
    /// The rod, rope or strut.
    pub link: ConstraintId,
    /// t \[s\].
    pub time: f64,
    /// Whether the tension is unique; if not, other tensions of redundant rods would do the same.
    pub is_unique: bool,
}

impl MaxTension {
    /// The larger of two in size, the former if they are equal.
    pub(crate) fn larger(former: Option<Self>, next: Option<Self>) -> Option<Self> {
        match (former, next) {
            (Some(former), Some(next)) if next.tension.abs() > former.tension.abs() => Some(next),
            (Some(former), _) => Some(former),
            (None, next) => next,
        }
    }
}

impl EventKind {
    /// The word for it: `impact`, `closed`, `opened`, `slipped`, `stuck` or `broke`.
    pub fn name(self) -> &'static str {
        match self {
            EventKind::Impact { .. } => "impact",
            EventKind::Closed => "closed",
            EventKind::Opened => "opened",
            EventKind::Slipped => "slipped",
            EventKind::Stuck => "stuck",
            EventKind::Broke => "broke",
        }
    }
}

impl fmt::Display for EventKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl StepReport {
    /// Books one substep that was kept: its length [s], its Newton iterations, and what it left of C = 0 and Ċ = 0. A
    /// substep without a length, at an event where it began, is not the smallest.
    pub(crate) fn book(&mut self, h: f64, iterations: usize, drift: &Drift) {
        self.substeps += 1;
        self.iterations += iterations;
        if h > 0.0 {
            self.smallest_substep = self.smallest_substep.min(h);
        }
        self.max_residual = larger(self.max_residual, drift.residual);
        self.max_residual_rate = larger(self.max_residual_rate, drift.residual_rate);
        self.max_relative_length_error = larger(self.max_relative_length_error, drift.relative_length);
    }

    /// Takes the next step's report into this one.
    pub(crate) fn absorb(&mut self, next: StepReport) {
        self.smallest_substep =
            if self.substeps == 0 { next.smallest_substep } else { self.smallest_substep.min(next.smallest_substep) };
        self.substeps += next.substeps;
        self.rejected += next.rejected;
        self.factorizations += next.factorizations;
        self.iterations += next.iterations;
        self.max_residual = larger(self.max_residual, next.max_residual);
        self.max_residual_rate = larger(self.max_residual_rate, next.max_residual_rate);
        self.max_relative_length_error = larger(self.max_relative_length_error, next.max_relative_length_error);
        self.max_tension = MaxTension::larger(self.max_tension, next.max_tension);
        self.energy = next.energy;
        (self.integrator, self.solver) = (next.integrator, next.solver);
        self.events.extend(next.events);
        for warning in next.warnings {
            self.warn(warning);
        }
    }

    /// Adds a warning; of two that are alike the worse stays.
    pub(crate) fn warn(&mut self, warning: Warning) {
        match self.warnings.iter_mut().find(|former| former.is_like(&warning)) {
            Some(former) => former.keep_worse(warning),
            None => self.warnings.push(warning),
        }
    }
}

/// A path to the multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Solver {
    /// Rows of A = J W Jᵀ, each component by its own method: see [`crate::System::components`].
    #[default]
    Rows,
    /// Open chains, eight side by side.
    Chains,
    /// Newton's method on a step that is solved at its end, with geometric stiffness: Radau IIA, BDF2, backward Euler.
    EndOfStep,
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Solver::Rows => "rows",
            Solver::Chains => "lanes",
            Solver::EndOfStep => "end of step",
        })
    }
}

/// The change that brought a state onto C = 0 and Ċ = 0.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Projection {
    /// The farthest any particle was moved \[m\]; 0 if the state was consistent.
    pub moved: f64,
    /// The largest change of a particle's velocity [m/s]; 0 if it was consistent.
    pub velocity_changed: f64,
    /// Whether that move is more than [`Settings::constraint_tolerance`](crate::Settings::constraint_tolerance) of the
    /// extent explains: then the start is not the one that was asked for.
    pub is_moved: bool,
    /// Whether that change is more than [`Settings::tolerance`](crate::Settings::tolerance) of the fastest velocity
    /// explains, the part of it by which every substep may be off.
    pub is_turned: bool,
    /// max |C| before \[C\].
    pub residual_before: f64,
    /// Newton iterations on C(q) = 0.
    pub iterations: usize,
}
