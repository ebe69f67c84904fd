//! Warnings: conditions that did not stop a step, and the log that tells each of them once.

use crate::settings::Integrator;
use crate::words::{Digits, Seconds};
use std::fmt;

/// A condition that did not stop the step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Warning {
    /// A is singular: rows depend on each other. λ is the share of [`Distance::stiffness`](crate::Distance::stiffness);
    /// Q̂ and the motion are unique.
    Singular,
    /// Rows whose gradient vanishes here, so that no multiplier can act through them.
    NoGradient {
        /// Their names.
        rows: Vec<String>,
    },
    /// Joints in a line, or in space in a plane, that rods hold only to second order: the tensions of these rods
    /// have no meaning, and `breaks_at` and `breaks_at_impulse` do not act on them.
    SecondOrder {
        /// The names of the joints of each such group.
        joints: Vec<Vec<String>>,
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
    /// Contacts that share a particle were struck at once, and share the blow as Newton's law of impact has it.
    SharedImpact {
        /// t of the impact \[s\].
        time: f64,
        /// Two of the constraints.
        constraints: [String; 2],
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
    /// In one step more than a hundredth of the largest kinetic energy came or went, and no work that is booked
    /// accounts for it: an error of the integrator. A [`Simulation`](crate::Simulation) keeps the account, so
    /// [`step`](crate::step()) does not warn of it.
    EnergyUnaccounted {
        /// t of the end of the step \[s\].
        time: f64,
        /// The change that nothing accounts for \[J\]; negative where energy was lost.
        energy: f64,
        /// The same over the largest kinetic energy so far \[1\].
        relative: f64,
        /// The integrator that advanced the step.
        integrator: Integrator,
    },
}

impl Warning {
    /// Whether both tell the same, perhaps of another time or in another size.
    pub(crate) fn is_like(&self, other: &Warning) -> bool {
        match (self, other) {
            (Warning::HandedOver { .. }, Warning::HandedOver { .. })
            | (Warning::SharedImpact { .. }, Warning::SharedImpact { .. })
            | (Warning::BudgetSpent { .. }, Warning::BudgetSpent { .. }) => true,
            (
                Warning::EnergyUnaccounted { energy, integrator, .. },
                Warning::EnergyUnaccounted { energy: other, integrator: by, .. },
            ) => integrator == by && (*energy < 0.0) == (*other < 0.0),
            _ => self == other,
        }
    }

    /// Takes a later warning that is like this one: the worse of the two stays.
    pub(crate) fn keep_worse(&mut self, later: Warning) {
        let is_worse = match (&*self, &later) {
            (Warning::BudgetSpent { relative, .. }, Warning::BudgetSpent { relative: later, .. })
            | (Warning::EnergyUnaccounted { relative, .. }, Warning::EnergyUnaccounted { relative: later, .. }) => {
                later.abs() > relative.abs() || later.is_nan()
            }
            _ => false,
        };
        if is_worse {
            *self = later;
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::Singular => f.write_str(
                "some constraints repeat what others say, so A = J W Jᵀ is singular: the motion and the total force \
                 are unique, the single multipliers are not: those that elastic rods would share are shown, and \
                 `tension_is_unique` marks them. `qhat check` counts the redundant rows",
            ),
            Warning::NoGradient { rows } => write!(
                f,
                "the gradient of {} is zero here, so no force can hold it, and A = J W Jᵀ is singular: use the modern \
                 form of the constraint, or start elsewhere (diagonal drag hides this)",
                rows.join(", ")
            ),
            Warning::SecondOrder { joints } => write!(
                f,
                "rods hold {} in a line or plane only to second order: the motion is right, but the tensions of these \
                 rods have no meaning, and no load breaks them. Hold these joints by \
                 `kind = \"rigid\"`, or one joint between two others by `kind = \"line\"`",
                groups(joints)
            ),
            Warning::TooStiff { substeps } => write!(
                f,
                "the motion is too stiff for the {substeps} substeps that frame_work and max_substeps allow a frame, \
                 so bdf2 carries it: rods hold, fast oscillations are damped. Raise frame_work to follow them"
            ),
            Warning::HandedOver { time } => write!(
                f,
                "rattle could not meet the constraints at t = {} s with a substep of any length, so dopri5 finished \
                 the frame. If this comes back, use dop853",
                Seconds(*time)
            ),
            Warning::SharedImpact { time, constraints: [one, other] } => write!(
                f,
                "`{one}` and `{other}` were struck at once at t = {} s, so they share the blow. Where it should pass \
                 from one to the next, as in Newton's cradle, leave a gap of 1e-6 m between them",
                Seconds(*time)
            ),
            Warning::BudgetSpent { time, iterations, row, relative } => write!(
                f,
                "the frame budget was spent at t = {} s after {iterations} Newton iterations, and `{row}` is off by \
                 {relative:.1e} of its size: raise frame_budget, or shorten h",
                Seconds(*time)
            ),
            Warning::EnergyUnaccounted { time, energy, relative, integrator } => {
                let what = if *energy < 0.0 { "energy was lost" } else { "energy appeared" };
                write!(
                    f,
                    "{what} without a cause: {} J, {} % of the largest kinetic energy, in one step that {integrator} \
                     ended at t = {} s; {}",
                    Digits(energy.abs()),
                    Digits(100.0 * relative.abs()),
                    Seconds(*time),
                    integrator.energy_advice()
                )
            }
        }
    }
}

/// Groups of names in words.
fn groups(groups: &[Vec<String>]) -> String {
    /// The most names of a group, and the most groups, that are written.
    const NAMES: usize = 6;
    const GROUPS: usize = 3;
    let more = |count: usize, most: usize, what: &str| match count.saturating_sub(most) {
        0 => String::new(),
        more => format!(" and {more} more{what}"),
    };
    let in_words = |names: &Vec<String>| {
        let quoted: Vec<String> = names.iter().take(NAMES).map(|name| format!("`{name}`")).collect();
        format!("{}{}", quoted.join(", "), more(names.len(), NAMES, ""))
    };
    let written: Vec<String> = groups.iter().take(GROUPS).map(in_words).collect();
    format!("{}{}", written.join("; "), more(groups.len(), GROUPS, " groups"))
}

/// A warning of a run, and when it was raised.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct RepeatedWarning {
    /// The warning; of several that differ in size the worst.
    pub warning: Warning,
    /// The number of frames that raised it.
    pub frames: usize,
    /// t of the first and the last of them \[s\].
    pub first: f64,
    /// See `first`.
    pub last: f64,
}

impl fmt::Display for RepeatedWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RepeatedWarning { warning, frames, first, last } = self;
        write!(f, "{warning}")?;
        if *frames > 1 {
            write!(f, " ({frames} frames, from t = {} s to t = {} s)", Seconds(*first), Seconds(*last))?;
        }
        Ok(())
    }
}

/// The warnings of a run, each told once.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WarningLog {
    entries: Vec<RepeatedWarning>,
}

impl WarningLog {
    /// Takes the warnings of a frame that ended at `time` \[s\].
    pub fn note<'a>(&mut self, warnings: impl IntoIterator<Item = &'a Warning>, time: f64) {
        for warning in warnings {
            match self.entries.iter_mut().find(|entry| entry.warning.is_like(warning)) {
                Some(entry) => {
                    // Terms and report of one frame may say the same.
                    entry.frames += usize::from(time != entry.last);
                    entry.last = time;
                    entry.warning.keep_worse(warning.clone());
                }
                None => {
                    let warning = warning.clone();
                    self.entries.push(RepeatedWarning { warning, frames: 1, first: time, last: time });
                }
            }
        }
    }

    /// The warnings, in the order in which they were first raised.
    pub fn entries(&self) -> &[RepeatedWarning] {
        &self.entries
    }

    /// The entry that a warning belongs to.
    pub fn entry(&self, warning: &Warning) -> Option<&RepeatedWarning> {
        self.entries.iter().find(|entry| entry.warning.is_like(warning))
    }
}
