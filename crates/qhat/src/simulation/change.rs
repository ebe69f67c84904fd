//! Changes between steps: settings, feedback, forces and forms. The energy that a change costs is booked in the energy
//! account.

use super::Simulation;
use crate::constraint::Formulation;
use crate::energy;
use crate::error::StepError;
use crate::force::{Acts, Drag, Force, ForceError, Gravity};
use crate::integrate::{check_finds_events, project};
use crate::point::{Motion, Vector};
use crate::settings::{Feedback, Settings, SettingsError};
use crate::space::{ForceId, in_dimension};
use crate::state::State;
use crate::system::{System, check_force};

impl Simulation {
    /// The feedback that acts: none where the integrator projects.
    pub fn feedback_in_use(&self) -> Feedback {
        self.settings.feedback_in_use(self.system.feedback)
    }

    /// Changes the settings. Under an integrator that projects, where the former one did not, the state is made
    /// consistent; the energy that this takes is booked as stabilization.
    ///
    /// # Errors
    /// Settings out of range; constraints that no positions near by satisfy. Nothing is changed then.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), StepError> {
        settings.check()?;
        check_finds_events(&self.system, &settings)?;
        if settings.integrator.projects() && !self.settings.integrator.projects() {
            let before = self.energy().total();
            project(&self.system, &mut self.state, &settings, &mut self.workspace)?;
            self.state.work.stabilization += self.energy().total() - before;
        }
        self.settings = settings;
        Ok(())
    }

    /// Changes ks, kd, diagonal drag and elasticity.
    ///
    /// # Errors
    /// A number out of range.
    pub fn set_feedback(&mut self, feedback: Feedback) -> Result<(), SettingsError> {
        feedback.check()?;
        self.system.feedback = feedback;
        Ok(())
    }

    /// Puts every constraint into the forms of a formulation.
    ///
    /// # Errors
    /// Constraints that in their new form no positions near by satisfy, under an integrator that projects. Nothing is
    /// changed then.
    pub fn set_formulation(&mut self, formulation: Formulation) -> Result<(), StepError> {
        let system = self.system.with_formulation(formulation);
        let mut workspace = self.workspace.renewed(&system);
        let mut state = State { carry: None, ..self.state.clone() };
        if self.settings.integrator.projects() {
            project(&system, &mut state, &self.settings, &mut workspace)?;
            let change = energy::energy(&system, &state).total() - self.energy().total();
            state.work.stabilization += change;
        }
        (self.system, self.state, self.workspace) = (system, state, workspace);
        Ok(())
    }

    /// Gives the parameters of the system new values, and goes back to the start that follows from them, with no
    /// particle grabbed ([`System::bind`], [`System::start`]). The first solve afterwards finds what depends on the
    /// geometry, such as the rows that follow from others. Bits and errors are those of a new simulation.
    ///
    /// # Errors
    /// As [`System::bind`] and [`Simulation::new`]. Nothing is changed then.
    pub fn bind(&mut self, values: &[f64]) -> Result<(), StepError> {
        let mut bound = self.clone();
        bound.release();
        bound.system.bind(values)?;
        bound.workspace = bound.workspace.renewed(&bound.system);
        bound.start = bound.system.start();
        bound.reset()?;
        *self = bound;
        Ok(())
    }

    /// Changes a force of the builder to another, of the same kind or not. The jump of the potential energy is booked
    /// as external work.
    ///
    /// # Errors
    /// An id that the system does not have; a force that the builder would refuse. Nothing is changed then.
    pub fn set_force(&mut self, id: ForceId, force: impl Into<Force>) -> Result<(), ForceError> {
        if id.0 >= self.system.force_names.len() {
            return Err(ForceError::NoForce { force: id.0 });
        }
        let force = force.into();
        self.check_force(&force)?;
        let is_between_the_same = self.system.forces[id.0].particles() == force.particles();
        self.change_forces(|forces| forces[id.0] = force);
        if !is_between_the_same {
            // Arrays of implicit methods know the pairs that forces couple.
            self.workspace = self.workspace.renewed(&self.system);
        }
        Ok(())
    }

    /// Changes uniform gravity [m/s²]: the first that there is, or a new one. The jump of the potential energy is
    /// booked as external work.
    ///
    /// # Errors
    /// A number that is not finite.
    pub fn set_gravity(&mut self, acceleration: impl Into<Vector>) -> Result<(), ForceError> {
        let acceleration = acceleration.into().0;
        self.put_force(Gravity { acceleration }.into(), |force| matches!(force, Force::Gravity(_)))
    }

    /// Uniform gravity [m/s²]; zero if there is none.
    pub fn gravity(&self) -> [f64; 3] {
        let found = self.system.forces.iter().find_map(|force| match force {
            Force::Gravity(gravity) => Some(gravity.acceleration),
            _ => None,
        });
        found.unwrap_or_default()
    }

    /// Changes the viscous drag on every particle [N·s/m]: the first that there is, or a new one.
    ///
    /// # Errors
    /// A number that is negative or not finite.
    pub fn set_drag(&mut self, coefficient: f64) -> Result<(), ForceError> {
        self.put_force(Drag { coefficient }.into(), |force| matches!(force, Force::Drag(_)))
    }

    /// The viscous drag on every particle [N·s/m]; zero if there is none.
    pub fn drag(&self) -> f64 {
        let found = self.system.forces.iter().find_map(|force| match force {
            Force::Drag(drag) => Some(drag.coefficient),
            _ => None,
        });
        found.unwrap_or_default()
    }

    /// Replaces the first force of a kind, or adds one.
    fn put_force(&mut self, force: Force, same_kind: fn(&Force) -> bool) -> Result<(), ForceError> {
        self.check_force(&force)?;
        self.change_forces(|forces| match forces.iter_mut().find(|force| same_kind(force)) {
            Some(place) => *place = force,
            None => forces.push(force),
        });
        Ok(())
    }

    pub(super) fn check_force(&self, force: &Force) -> Result<(), ForceError> {
        check_force(force, self.system.dimension, self.system.particle_count())
    }

    /// Changes forces between steps and books the jump of the potential energy as external work.
    pub(super) fn change_forces(&mut self, change: impl FnOnce(&mut Vec<Force>)) {
        let potential = |system: &System, state: &State| {
            in_dimension!(system.dimension, D => {
                let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
                energy::potential(system, motion, &state.modes.broken)
            })
        };
        let before = potential(&self.system, &self.state);
        change(&mut self.system.forces);
        self.state.work.external += potential(&self.system, &self.state) - before;
    }
}
