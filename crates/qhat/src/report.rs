//! Reports of steps: substeps, errors, events and warnings.

use crate::drift::Drift;
use crate::energy::Energy;
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
    /// Factorizations of A. Open chains are factored in every solve; these do not count.
    pub factorizations: usize,
    /// Newton iterations on C(q) = 0.
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
        self.max_residual = self.max_residual.max(drift.residual);
        self.max_residual_rate = self.max_residual_rate.max(drift.residual_rate);
        self.max_relative_length_error = self.max_relative_length_error.max(drift.relative_length);
    }

    /// Takes the next step's report into this one.
    pub(crate) fn absorb(&mut self, next: StepReport) {
        self.smallest_substep =
            if self.substeps == 0 { next.smallest_substep } else { self.smallest_substep.min(next.smallest_substep) };
        self.substeps += next.substeps;
        self.rejected += next.rejected;
        self.factorizations += next.factorizations;
        self.iterations += next.iterations;
        self.max_residual = self.max_residual.max(next.max_residual);
        self.max_residual_rate = self.max_residual_rate.max(next.max_residual_rate);
        self.max_relative_length_error = self.max_relative_length_error.max(next.max_relative_length_error);
        self.max_tension = MaxTension::larger(self.max_tension, next.max_tension);
        self.energy = next.energy;
        (self.integrator, self.solver) = (next.integrator, next.solver);
        self.events.extend(next.events);
        for warning in next.warnings {
            self.warn(warning);
        }
    }

    /// Adds a warning unless it is there already; of spent budgets the worst stays.
    pub(crate) fn warn(&mut self, warning: Warning) {
        if let Warning::BudgetSpent { relative, .. } = warning {
            let same = |other: &&mut Warning| matches!(other, Warning::BudgetSpent { .. });
            if let Some(former) = self.warnings.iter_mut().find(same) {
                if matches!(former, Warning::BudgetSpent { relative: before, .. } if *before < relative) {
                    *former = warning;
                }
                return;
            }
        }
        if !self.warnings.contains(&warning) {
            self.warnings.push(warning);
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
    /// Newton's method at the end of the step, with geometric stiffness.
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

/// A condition that did not stop the step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Warning {
    /// A is singular: rows depend on each other. λ is the least-norm one; Q̂ and the motion are unique.
    Singular,
    /// Rows whose gradient vanishes here, so that no multiplier can act through them.
    NoGradient {
        /// Their names.
        rows: Vec<String>,
    },
    /// Auto went over to bdf2: accurate substeps would have taken more work than a frame is allowed.
    TooStiff {
        /// The number of substeps that the frame is allowed.
        substeps: usize,
    },
    /// RATTLE could not meet the constraints with substeps of any length: dopri5 carried the frame on.
    HandedOver {
        /// t where it took over \[s\].
        time: f64,
    },
    /// The frame budget was spent before the step was solved: it ends with the nearest that was reached.
    BudgetSpent {
        /// t of the end of the step \[s\].
        time: f64,
        /// Newton iterations of the frame.
        iterations: usize,
        /// The worst row.
        row: String,
        /// Its |C| relative to its own scale.
        relative: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::Singular => f.write_str(
                "some constraints repeat what others say, so A = J W Jᵀ is singular: the motion and the total force \
                 are unique, the single multipliers are not, and the smallest that do it are shown. `qhat check` \
                 counts the redundant rows",
            ),
            Warning::NoGradient { rows } => write!(
                f,
                "the gradient of {} is zero here, so no force can hold it, and A = J W Jᵀ is singular: use the modern \
                 form of the constraint, or start elsewhere (diagonal drag hides this)",
                rows.join(", ")
            ),
            Warning::TooStiff { substeps } => write!(
                f,
                "the motion is too stiff for the {substeps} substeps that frame_work and max_substeps allow a frame, \
                 so bdf2 carries it: rods hold, fast oscillations are damped. Raise frame_work to follow them"
            ),
            Warning::HandedOver { time } => write!(
                f,
                "rattle could not meet the constraints at t = {time:.4} s with a substep of any length, so dopri5 \
                 finished the frame. If this comes back, use dop853"
            ),
            Warning::BudgetSpent { time, iterations, row, relative } => write!(
                f,
                "the frame budget was spent at t = {time:.4} s after {iterations} Newton iterations, and `{row}` is \
                 off by {relative:.1e} of its size: raise frame_budget, or shorten h"
            ),
        }
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
