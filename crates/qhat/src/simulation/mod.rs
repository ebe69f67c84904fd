//! Simulation: a system in motion. It owns the system, its state, the settings and the workspace.

mod account;
mod change;
mod hand;
mod look;
mod power;
#[cfg(feature = "serde")]
mod saved;

use crate::energy::Energy;
use crate::error::StepError;
use crate::integrate::{Workspace, check_start, consistent, project, step_for};
use crate::multiplier::{Freedom, freedom, second_order};
use crate::report::{Projection, StepReport, WarningLog};
use crate::settings::Settings;
use crate::state::State;
use crate::structure::FlatClique;
use crate::system::System;
use account::EnergyAccount;
pub use power::Powers;

/// A system in motion: [`step`](Self::step) or [`advance`](Self::advance) it, look at its
/// [tensions](Self::links), [reactions](Self::reaction) and [energy](Self::energy), change
/// [forces](Self::set_force) and [settings](Self::set_settings) between steps, and [take hold](Self::grab) of a
/// particle.
#[derive(Clone, Debug)]
pub struct Simulation {
    system: System,
    state: State,
    settings: Settings,
    /// The settings under which the start was made consistent.
    begun_with: Settings,
    workspace: Workspace,
    start: State,
    projection: Projection,
    account: EnergyAccount,
    log: WarningLog,
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
            log: WarningLog::default(),
            system,
            state,
            settings,
            begun_with: settings,
        };
        simulation.begin()?;
        Ok(simulation)
    }

    fn begin(&mut self) -> Result<(), StepError> {
        self.begun_with = self.settings;
        self.projection = Projection::default();
        // Also before the projection, whose error would name a constraint.
        check_start(&self.system, &self.state, &self.settings)?;
        self.hold_second_order()?;
        if self.settings.integrator.projects() {
            self.projection = project(&self.system, &mut self.state, &self.settings, &mut self.workspace)?;
        }
        check_start(&self.system, &self.state, &self.settings)?;
        self.account = EnergyAccount::open(&self.system, &self.state);
        self.log = WarningLog::default();
        Ok(())
    }

    /// Gives the system rows for joints that its rods hold only to second order. They are found, and measured, at the
    /// consistent positions that are nearest to the start.
    fn hold_second_order(&mut self) -> Result<(), StepError> {
        let flat = self.system.flat_cliques(&self.state);
        if flat.is_empty() && self.system.second_order.is_empty() {
            return Ok(());
        }
        let mut system = self.system.clone();
        system.set_second_order(Vec::new(), &[]);
        match consistent(&system, &self.state, &self.settings) {
            Ok(start) => {
                let cliques = second_order(&system, &start, flat);
                system.set_second_order(cliques, &start.q);
            }
            Err(error) if self.settings.integrator.projects() => return Err(error),
            // Without consistent positions, rods that hold nothing are not told from others.
            Err(_) => {}
        }
        if !(system.second_order.is_empty() && self.system.second_order.is_empty()) {
            self.workspace = self.workspace.renewed(&system);
            self.system = system;
        }
        Ok(())
    }

    /// Takes one step of h, or with an adaptive integrator one frame of h.
    ///
    /// # Errors
    /// See [`StepError`]; the last good state stays.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let report = self.step_by(self.settings.h)?;
        self.log.note(&report.warnings, self.state.time());
        Ok(report)
    }

    /// Advances by a duration \[s\]: one frame with an adaptive integrator, steps of h with another.
    ///
    /// # Errors
    /// [`SettingsError::FrameNotMultiple`](crate::SettingsError::FrameNotMultiple) if steps of h do not fill the
    /// duration; else as [`Simulation::step`].
    pub fn advance(&mut self, duration: f64) -> Result<StepReport, StepError> {
        let is_adaptive = self.settings.integrator.is_adaptive();
        let (steps, h) = if is_adaptive { (1, duration) } else { (self.settings.steps_in(duration)?, self.settings.h) };
        let mut report = StepReport::default();
        let outcome = (0..steps).try_for_each(|_| self.step_by(h).map(|step| report.absorb(step)));
        self.log.note(&report.warnings, self.state.time());
        outcome.map(|()| report)
    }

    /// One step or frame of h [s], booked in the energy account.
    fn step_by(&mut self, h: f64) -> Result<StepReport, StepError> {
        let mut report = step_for(&self.system, &mut self.state, &self.settings, h, &mut self.workspace);
        self.account.note(&self.energy(), self.state.time(), report.as_mut().ok());
        report
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

    /// The joints that rods hold only to second order, found at the start: three in a line whose rods' lengths add up
    /// and that no other row holds across it, four in a plane in space with all their distances. They move as if they
    /// were one rigid body. No finite tensions of these rods do the same, so their tensions have no meaning:
    /// [`StepReport::max_tension`] leaves them out, and they break nothing.
    pub fn second_order(&self) -> &[FlatClique] {
        &self.system.second_order
    }

    /// The degrees of freedom at the present position and of the mechanism near by, which differ where rods hold only
    /// to second order; `None` where none do.
    pub fn freedom(&self) -> Option<Freedom> {
        freedom(&self.system, &self.state)
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

    /// The warnings of all steps since the start, each told once, with the number of frames that raised it and the
    /// times of the first and the last of them.
    pub fn warnings(&self) -> &WarningLog {
        &self.log
    }
}
