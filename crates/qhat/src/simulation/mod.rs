//! Simulation: a system in motion. It owns the system, its state, the settings and the workspace.

mod account;
mod change;
mod hand;
mod look;

use crate::energy::Energy;
use crate::error::StepError;
use crate::integrate::{Workspace, check_finds_events, check_start, project, step, step_for};
use crate::report::{Projection, StepReport};
use crate::settings::Settings;
use crate::state::State;
use crate::system::System;
use account::EnergyAccount;

/// A system in motion: [`step`](Self::step) or [`advance`](Self::advance) it, look at its
/// [tensions](Self::links), [reactions](Self::reaction) and [energy](Self::energy), change
/// [forces](Self::set_force) and [settings](Self::set_settings) between steps, and [take hold](Self::grab) of a
/// particle.
#[derive(Clone, Debug)]
pub struct Simulation {
    system: System,
    state: State,
    settings: Settings,
    workspace: Workspace,
    start: State,
    projection: Projection,
    account: EnergyAccount,
}

impl Simulation {
    /// A simulation that starts from a state. An integrator that projects starts from the nearest consistent state, and
    /// [`Simulation::projection`] says how far that is.
    ///
    /// # Errors
    /// Settings out of range; constraints that no positions near by satisfy; a start beyond what a contact or limit
    /// allows; an integrator that finds no events where there are some.
    pub fn new(system: System, state: State, settings: Settings) -> Result<Self, StepError> {
        settings.check()?;
        let mut simulation = Simulation {
            workspace: Workspace::new(&system),
            start: state.clone(),
            projection: Projection::default(),
            account: EnergyAccount::default(),
            system,
            state,
            settings,
        };
        simulation.begin()?;
        Ok(simulation)
    }

    fn begin(&mut self) -> Result<(), StepError> {
        self.projection = Projection::default();
        check_finds_events(&self.system, &self.settings)?;
        if self.settings.integrator.projects() {
            self.projection = project(&self.system, &mut self.state, &self.settings, &mut self.workspace)?;
        }
        check_start(&self.system, &self.state, &self.settings)?;
        self.account = EnergyAccount::open(&self.system, &self.state);
        Ok(())
    }

    /// Takes one step of h, or with an adaptive integrator one frame of h.
    ///
    /// # Errors
    /// See [`StepError`]; the last good state stays.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let report = step(&self.system, &mut self.state, &self.settings, &mut self.workspace);
        self.account.note(&self.energy());
        report
    }

    /// Advances by a duration \[s\]: one frame with an adaptive integrator, steps of h with another.
    ///
    /// # Errors
    /// [`SettingsError::FrameNotMultiple`](crate::SettingsError::FrameNotMultiple) if steps of h do not fill the duration; else as [`Simulation::step`].
    pub fn advance(&mut self, duration: f64) -> Result<StepReport, StepError> {
        if self.settings.integrator.is_adaptive() {
            let report = step_for(&self.system, &mut self.state, &self.settings, duration, &mut self.workspace);
            self.account.note(&self.energy());
            return report;
        }
        let steps = self.settings.steps_in(duration)?;
        let mut report = StepReport::default();
        for _ in 0..steps {
            report.absorb(self.step()?);
        }
        Ok(report)
    }

    /// Goes back to the start, with no particle grabbed; settings, forces and forms stay as they are now.
    ///
    /// # Errors
    /// As [`Simulation::new`], if the settings changed to ones under which the start cannot be made consistent.
    pub fn reset(&mut self) -> Result<(), StepError> {
        self.release();
        self.state = self.start.clone();
        self.begin()
    }

    /// The system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The change that made the start consistent.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// The energy account at the present state.
    pub fn energy(&self) -> Energy {
        crate::energy::energy(&self.system, &self.state)
    }

    /// The energy that is missing at the present state, relative to the largest kinetic energy so far \[1\]; negative
    /// where energy was lost. The divisor is at least a millionth of the work that the applied forces could do over the
    /// length of the system, because the kinetic energy of a structure at rest is roundoff.
    pub fn energy_error(&self) -> f64 {
        self.account.error(&self.energy())
    }

    /// The largest size of the missing energy after any step so far, relative to the same \[1\].
    pub fn energy_error_max(&self) -> f64 {
        self.account.largest_error()
    }
}
