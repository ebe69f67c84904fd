//! The energy account of a run: the energy that is missing, and the scale that it is compared with.
//!
//! ```text
//! missing = (T + V − work)(t) − (T + V − work)(0)     [J]
//! relative = missing/max(largest T so far, FLOOR × work of the applied forces over the length of the system)
//! ```

use crate::energy::{self, Energy};
use crate::state::State;
use crate::system::System;

/// The share of the energy scale below which a kinetic energy does not count as motion [1]. Energy errors are relative
/// to the largest kinetic energy, and for a structure at rest that must not be roundoff.
const FLOOR: f64 = 1e-6;

/// The energy that a run has had and lost since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EnergyAccount {
    /// T + V less the work that came in, at the start [J].
    balance: f64,
    /// The largest T so far [J].
    largest_kinetic: f64,
    /// The least energy that errors are relative to [J].
    floor: f64,
    /// The largest that was missing after any step [J].
    largest_missing: f64,
}

impl EnergyAccount {
    /// The account of a run that begins at a state.
    pub(super) fn open(system: &System, state: &State) -> Self {
        let energy = energy::energy(system, state);
        EnergyAccount {
            balance: energy.balance(),
            largest_kinetic: energy.kinetic,
            floor: FLOOR * energy::energy_scale(system, state),
            largest_missing: 0.0,
        }
    }

    /// Takes the energy after a step.
    pub(super) fn note(&mut self, energy: &Energy) {
        self.largest_kinetic = self.largest_kinetic.max(energy.kinetic);
        self.largest_missing = self.largest_missing.max(self.missing(energy).abs());
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
        if energy == 0.0 { 0.0 } else { energy / self.largest_kinetic.max(self.floor) }
    }
}
