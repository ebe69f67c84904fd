//! Simulations as bytes: all that a run needs to go on in another process as if it had not stopped.

use super::{EnergyAccount, Simulation};
use crate::report::{Projection, WarningLog};
use crate::saved::{Kind, RestoreError, fits, from_bytes, to_bytes};
use crate::settings::Settings;
use crate::state::State;
use crate::system::System;
use serde::{Deserialize, Serialize};

/// The data that a simulation owns beside its system.
#[derive(Serialize, Deserialize)]
struct Saved {
    state: State,
    settings: Settings,
    begun_with: Settings,
    start: State,
    projection: Projection,
    account: EnergyAccount,
    log: WarningLog,
    records_tension: bool,
}

impl Simulation {
    /// The simulation as bytes, without its system: state, start, settings, energy account, warnings.
    /// [`Simulation::restore`] goes on from them with the same bits.
    pub fn to_bytes(&self) -> Vec<u8> {
        let saved = Saved {
            state: self.state.clone(),
            settings: self.settings,
            begun_with: self.begun_with,
            start: self.start.clone(),
            projection: self.projection.clone(),
            account: self.account.clone(),
            log: self.log.clone(),
            records_tension: self.workspace.watches_tension(),
        };
        to_bytes(Kind::Simulation, &self.system, &saved)
    }

    /// The simulation of a system from its bytes, in this process or another, on any target.
    ///
    /// ```
    /// # use qhat::{Dimension, Gravity, Particle, Settings, Simulation, System};
    /// # let mut builder = System::builder(Dimension::Two);
    /// # builder.with_particle(Particle::at("stone", [0.0, 10.0])).with_force(Gravity::new([0.0, -9.81]));
    /// let (system, state) = builder.build()?;
    /// let mut simulation = Simulation::new(system.clone(), state, Settings::default())?;
    /// simulation.advance(0.5)?;
    /// let bytes = simulation.to_bytes();
    ///
    /// let mut restored = Simulation::restore(system, &bytes)?;
    /// assert_eq!(restored.state().time(), 0.5);
    /// restored.advance(0.5)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Bytes that are no simulation, of another version or damaged; those of a system in which a part or a number
    /// differs, as by a hand that held a particle.
    pub fn restore(system: System, bytes: &[u8]) -> Result<Simulation, RestoreError> {
        let saved: Saved = from_bytes(Kind::Simulation, &system, bytes)?;
        if !fits(&saved.start, &system) {
            return Err(RestoreError::Damaged);
        }
        // The start gives rows to joints that rods hold only to second order.
        let mut simulation = Simulation::new(system, saved.start, saved.begun_with)?;
        if !fits(&saved.state, &simulation.system) {
            return Err(RestoreError::Damaged);
        }
        (simulation.state, simulation.settings) = (saved.state, saved.settings);
        simulation.projection = saved.projection;
        simulation.account = saved.account;
        simulation.log = saved.log;
        simulation.workspace = simulation.workspace.renewed(&simulation.system);
        simulation.record_tension(saved.records_tension);
        Ok(simulation)
    }
}
