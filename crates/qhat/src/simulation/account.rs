//! The energy account of a run: the energy that is missing, and the scale that it is compared with.
//!
//! ```text
//! missing = (T + V − work)(t) − (T + V − work)(0)     [J]
//! relative = missing/max(largest T so far, FLOOR × work of the applied forces over the length of the system)
//! ```
//!
//! A step that changes the missing energy by more than `SPOKEN` of the largest T is told. A method of fixed step makes
//! its first errors from rest, where the largest T so far says nothing yet: there a change waits until the kinetic
//! energy no longer grows from step to step, at most for `WAITS` steps, and is told if it is still large.

use crate::energy::{self, Energy};
use crate::point::larger;
use crate::report::{StepReport, Warning};
use crate::settings::Integrator;
use crate::state::State;
use crate::system::System;

/// The share of the energy scale below which a kinetic energy does not count as motion [1]. Energy errors are relative
/// to the largest kinetic energy, and for a structure at rest that must not be roundoff.
const FLOOR: f64 = 1e-6;

/// The change of the missing energy in one step, over the largest kinetic energy, that is told [1].
const SPOKEN: f64 = 0.01;

/// Steps for which a change may wait while the kinetic energy grows: in a fall from rest the n-th step of Euler's
/// method misses 1/n² of the kinetic energy, which is below `SPOKEN` from the eleventh on.
const WAITS: u32 = 16;

/// Roundoff of T + V, in units of ε (|T| + |V|): sums over all particles and forces lose a few bits.
const ROUNDOFF: f64 = 64.0;

/// The energy that a run has had and lost since its start.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct EnergyAccount {
    /// T + V less the work that came in, at the start [J].
    balance: f64,
    /// The largest T so far [J].
    largest_kinetic: f64,
    /// The least energy that errors are relative to [J].
    floor: f64,
    /// What was missing after the last step [J].
    missing: f64,
    /// The largest that was missing after any step [J].
    largest_missing: f64,
    /// A large change that was not told yet, and for how many steps it has waited.
    waiting: Option<(Change, u32)>,
}

/// A change of the missing energy in one step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Change {
    time: f64,
    energy: f64,
    integrator: Integrator,
}

impl EnergyAccount {
    /// The account of a run that begins at a state.
    pub(super) fn open(system: &System, state: &State) -> Self {
        let energy = energy::energy(system, state);
        EnergyAccount {
            balance: energy.balance(),
            largest_kinetic: energy.kinetic,
            floor: FLOOR * energy::energy_scale(system, state),
            ..EnergyAccount::default()
        }
    }

    /// Takes the energy after a step that ended at `time` [s]; adds to its report what is to be told of it.
    pub(super) fn note(&mut self, energy: &Energy, time: f64, report: Option<&mut StepReport>) {
        let missing = self.missing(energy);
        let change = missing - std::mem::replace(&mut self.missing, missing);
        let grows = energy.kinetic > self.largest_kinetic;
        self.largest_kinetic = larger(self.largest_kinetic, energy.kinetic);
        self.largest_missing = larger(self.largest_missing, missing.abs());
        let Some(report) = report else { return };
        let integrator = report.integrator;
        if self.is_large(change, energy) {
            let change = Change { time, energy: change, integrator };
            match &mut self.waiting {
                Some((former, _)) if former.energy.abs() > change.energy.abs() => {}
                Some((former, _)) => *former = change,
                None => self.waiting = Some((change, 0)),
            }
        }
        let Some((change, waited)) = &mut self.waiting else { return };
        *waited += 1;
        // An error estimate does not let the first step of an adaptive method miss much.
        if grows && *waited < WAITS && !integrator.is_adaptive() {
            return;
        }
        let Change { time, energy: missed, integrator } = change.clone();
        self.waiting = None;
        if self.is_large(missed, energy) {
            let relative = self.relative(missed);
            report.warn(Warning::EnergyUnaccounted { time, energy: missed, relative, integrator });
        }
    }

    /// Whether a change in one step is to be told.
    fn is_large(&self, change: f64, energy: &Energy) -> bool {
        let roundoff = ROUNDOFF * f64::EPSILON * (energy.kinetic.abs() + energy.potential.abs());
        change.abs() > SPOKEN * larger(self.largest_kinetic, self.floor) + roundoff
    }

    /// The energy that is missing [J]; negative where energy was lost.
    fn missing(&self, energy: &Energy) -> f64 {
        energy.balance() - self.balance
    }

    /// The missing energy, relative to the largest kinetic energy so far [1].
    pub(super) fn error(&self, energy: &Energy) -> f64 {
        self.relative(self.missing(energy))
    }

    /// The largest size of the missing energy after any step so far, relative to the same [1].
    pub(super) fn largest_error(&self) -> f64 {
        self.relative(self.largest_missing)
    }

    fn relative(&self, energy: f64) -> f64 {
        if energy == 0.0 { 0.0 } else { energy / larger(self.largest_kinetic, self.floor) }
    }
}
