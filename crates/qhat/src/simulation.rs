//! Simulation: the easy door. Owns a system, its state, the settings and the workspace.

use crate::constraint::Formulation;
use crate::energy::{self, Energy};
use crate::error::{SettingsError, StepError};
use crate::force::{Acts, Drag, Force, Gravity, MouseSpring};
use crate::integrate::{Workspace, check_start, check_switches, project, step, step_for};
use crate::point::Motion;
use crate::report::{Projection, StepReport};
use crate::settings::{Feedback, Settings};
use crate::space::{ParticleId, in_dimension};
use crate::state::State;
use crate::system::System;
use crate::terms::Terms;

/// The share of the energy scale below which a kinetic energy does not count as motion: energy errors are relative to the
/// largest kinetic energy, and for a structure at rest that must not be roundoff.
const ENERGY_FLOOR: f64 = 1e-6;

/// A system in motion.
#[derive(Clone, Debug)]
pub struct Simulation {
    system: System,
    state: State,
    settings: Settings,
    workspace: Workspace,
    start: State,
    projection: Projection,
    /// T + V less what came in, at the start [J].
    balance: f64,
    largest_kinetic: f64,
    energy_floor: f64,
    largest_missing: f64,
}

impl Simulation {
    /// Starts from a state. An integrator that projects starts from the nearest consistent one, and
    /// [`Simulation::projection`] says what that took.
    ///
    /// # Errors
    /// Settings out of range; constraints that no positions near by satisfy; a start beyond what a contact or limit allows; an
    /// integrator that finds no events where there are some.
    pub fn new(system: System, state: State, settings: Settings) -> Result<Self, StepError> {
        settings.check()?;
        let mut simulation = Simulation {
            workspace: Workspace::new(&system),
            start: state.clone(),
            projection: Projection::default(),
            balance: 0.0,
            largest_kinetic: 0.0,
            energy_floor: 0.0,
            largest_missing: 0.0,
            system,
            state,
            settings,
        };
        simulation.begin()?;
        Ok(simulation)
    }

    fn begin(&mut self) -> Result<(), StepError> {
        self.projection = Projection::default();
        check_switches(&self.system, &self.settings)?;
        if self.settings.integrator.projects() {
            self.projection = project(&self.system, &mut self.state, &self.settings, &mut self.workspace)?;
        }
        check_start(&self.system, &self.state, &self.settings)?;
        self.energy_floor = ENERGY_FLOOR * energy::energy_scale(&self.system, &self.state);
        let energy = self.energy();
        self.balance = energy.balance();
        self.largest_kinetic = energy.kinetic;
        self.largest_missing = 0.0;
        Ok(())
    }

    /// One step of h, or for an adaptive integrator one frame of h.
    ///
    /// # Errors
    /// See [`StepError`]; the last good state stays.
    pub fn step(&mut self) -> Result<StepReport, StepError> {
        let report = step(&self.system, &mut self.state, &self.settings, &mut self.workspace);
        self.note_energy();
        report
    }

    /// Advances by a duration [s]: one frame for an adaptive integrator, steps of h for another.
    ///
    /// # Errors
    /// [`SettingsError::FrameNotMultiple`] if steps of h do not fill it; else as [`Simulation::step`].
    pub fn advance(&mut self, duration: f64) -> Result<StepReport, StepError> {
        if self.settings.integrator.is_adaptive() {
            let report = step_for(&self.system, &mut self.state, &self.settings, duration, &mut self.workspace);
            self.note_energy();
            return report;
        }
        let steps = steps_in(duration, self.settings.h)?;
        let mut report = StepReport::default();
        for _ in 0..steps {
            report.absorb(self.step()?);
        }
        Ok(report)
    }

    fn note_energy(&mut self) {
        self.largest_kinetic = self.largest_kinetic.max(self.energy().kinetic);
        self.largest_missing = self.largest_missing.max(self.missing_energy().abs());
    }

    /// Back to where it started, with nothing held; settings, forces and forms stay as they are now.
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

    /// What it took to make the start consistent.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Every symbol of the equation at the present state, with the feedback that the integrator uses.
    pub fn terms(&mut self) -> Terms {
        let feedback = self.feedback_in_use();
        self.workspace.terms(&self.system, &self.state, &feedback)
    }

    /// Signed tension of every link ([`System::links`]) at the present state, as applied [N].
    pub fn tension(&mut self) -> Vec<f64> {
        let feedback = self.feedback_in_use();
        self.workspace.tension(&self.system, &self.state, &feedback)
    }

    /// The energy account at the present state.
    pub fn energy(&self) -> Energy {
        energy::energy(&self.system, &self.state)
    }

    /// What is missing in the energy account at the present state [J]; negative where energy was lost.
    fn missing_energy(&self) -> f64 {
        self.energy().balance() - self.balance
    }

    /// What is missing in the energy account, over the largest kinetic energy so far (at least a millionth of the work that
    /// the applied forces could do over the system's own length, so that a structure at rest divides by something).
    /// Negative where energy was lost.
    pub fn energy_error(&self) -> f64 {
        self.relative_energy(self.missing_energy())
    }

    /// The largest that was missing after any step so far, over the same.
    pub fn energy_error_max(&self) -> f64 {
        self.relative_energy(self.largest_missing)
    }

    fn relative_energy(&self, energy: f64) -> f64 {
        if energy == 0.0 { 0.0 } else { energy / self.largest_kinetic.max(self.energy_floor) }
    }

    /// The feedback that acts: none where the integrator projects.
    pub fn feedback_in_use(&self) -> Feedback {
        if self.settings.integrator.projects() { Feedback::NONE } else { self.system.feedback }
    }

    /// Changes the settings while running. Going over to an integrator that projects, the state is made consistent; the
    /// energy that takes is booked as stabilization.
    ///
    /// # Errors
    /// Settings out of range; constraints that no positions near by satisfy. Nothing is changed then.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), StepError> {
        settings.check()?;
        check_switches(&self.system, &settings)?;
        if settings.integrator.projects() && !self.settings.integrator.projects() {
            let before = self.energy().total();
            project(&self.system, &mut self.state, &settings, &mut self.workspace)?;
            self.state.work.stabilization += self.energy().total() - before;
        }
        self.settings = settings;
        Ok(())
    }

    /// Changes ks, kd, diagonal drag and elasticity while running.
    ///
    /// # Errors
    /// A number out of range.
    pub fn set_feedback(&mut self, feedback: Feedback) -> Result<(), SettingsError> {
        feedback.check()?;
        self.system.feedback = feedback;
        Ok(())
    }

    /// Changes uniform gravity [m/s²] while running; the energy this adds is booked as external work.
    ///
    /// # Errors
    /// A number that is not finite, in words.
    pub fn set_gravity(&mut self, acceleration: [f64; 3]) -> Result<(), String> {
        self.set_force(Gravity { acceleration }.into(), |force| matches!(force, Force::Gravity(_)))
    }

    /// Uniform gravity [m/s²]; zero if there is none.
    pub fn gravity(&self) -> [f64; 3] {
        let found = self.system.forces.iter().find_map(|force| match force {
            Force::Gravity(gravity) => Some(gravity.acceleration),
            _ => None,
        });
        found.unwrap_or_default()
    }

    /// Changes the viscous drag [N·s/m] while running.
    ///
    /// # Errors
    /// A number that is negative or not finite, in words.
    pub fn set_drag(&mut self, coefficient: f64) -> Result<(), String> {
        self.set_force(Drag { coefficient }.into(), |force| matches!(force, Force::Drag(_)))
    }

    /// The viscous drag [N·s/m]; zero if there is none.
    pub fn drag(&self) -> f64 {
        let found = self.system.forces.iter().find_map(|force| match force {
            Force::Drag(drag) => Some(drag.coefficient),
            _ => None,
        });
        found.unwrap_or_default()
    }

    /// Puts every constraint into the forms of a formulation while running.
    ///
    /// # Errors
    /// Where the integrator projects and the constraints in their new form cannot be satisfied near by.
    pub fn set_formulation(&mut self, formulation: Formulation) -> Result<(), StepError> {
        self.set_system(self.system.with_formulation(formulation))
    }

    fn set_system(&mut self, system: System) -> Result<(), StepError> {
        let mut workspace = Workspace::new(&system);
        let mut state = State { carry: None, ..self.state.clone() };
        if self.settings.integrator.projects() {
            project(&system, &mut state, &self.settings, &mut workspace)?;
            let change = energy::energy(&system, &state).total() - self.energy().total();
            state.work.stabilization += change;
        }
        (self.system, self.state, self.workspace) = (system, state, workspace);
        Ok(())
    }

    /// Takes hold of a particle with a mouse spring whose stiffness suits the mass it pulls.
    ///
    /// # Errors
    /// A particle that does not exist or a target that is not finite, in words.
    pub fn grab(&mut self, particle: ParticleId, target: [f64; 3]) -> Result<(), String> {
        let (stiffness, damping) = self.grip(particle);
        let mouse = MouseSpring { particle, target, stiffness, damping };
        self.set_force(mouse.into(), |force| matches!(force, Force::MouseSpring(_)))
    }

    /// Moves the point that the mouse spring pulls to [m]; nothing if no particle is held.
    ///
    /// # Errors
    /// A target that is not finite, in words.
    pub fn drag_to(&mut self, target: [f64; 3]) -> Result<(), String> {
        match self.mouse().cloned() {
            Some(mouse) => {
                self.set_force(MouseSpring { target, ..mouse }.into(), |force| matches!(force, Force::MouseSpring(_)))
            }
            None => Ok(()),
        }
    }

    /// Lets go.
    pub fn release(&mut self) {
        self.change_forces(|forces| forces.retain(|force| !matches!(force, Force::MouseSpring(_))));
    }

    /// The mouse spring, if a particle is held.
    pub fn mouse(&self) -> Option<&MouseSpring> {
        self.system.forces.iter().find_map(|force| match force {
            Force::MouseSpring(mouse) => Some(mouse),
            _ => None,
        })
    }

    /// Stiffness [N/m] and damping [N·s/m] of a mouse spring on a particle: the mass that hangs together with it follows
    /// the hand in about half a second, at two thirds of critical damping.
    fn grip(&self, particle: ParticleId) -> (f64, f64) {
        const FREQUENCY: f64 = 2.0 * std::f64::consts::PI * 2.0; // rad/s
        const DAMPING_RATIO: f64 = 0.65;
        let mass = self.system.connected_mass(particle);
        let (mut stiffness, mut damping) = (mass * FREQUENCY * FREQUENCY, 2.0 * DAMPING_RATIO * mass * FREQUENCY);
        if !self.settings.integrator.is_adaptive() && !self.settings.integrator.is_implicit() {
            // A light particle on a heavy body feels the whole spring; steps of a fixed h must remain stable for it alone.
            let h = self.settings.h;
            let w = self.system.inverse_mass.get(particle.0).copied().unwrap_or(0.0);
            stiffness = stiffness.min(0.25 / (w * h * h));
            damping = damping.min(0.25 / (w * h));
        }
        (stiffness, damping)
    }

    /// Replaces the force of a kind, or adds it.
    fn set_force(&mut self, force: Force, same_kind: fn(&Force) -> bool) -> Result<(), String> {
        force.check()?;
        if let Some(id) = force.particles().into_iter().find(|id| id.0 >= self.system.particle_count()) {
            return Err(format!("there is no particle number {}", id.0));
        }
        self.change_forces(|forces| match forces.iter_mut().find(|force| same_kind(force)) {
            Some(place) => *place = force,
            None => forces.push(force),
        });
        Ok(())
    }

    /// Changes forces between steps and books the jump of the potential energy as external work.
    fn change_forces(&mut self, change: impl FnOnce(&mut Vec<Force>)) {
        let potential = |system: &System, state: &State| {
            in_dimension!(system.dimension, D => {
                energy::potential(system, Motion::<D> { q: &state.q, qd: &state.qd, t: state.t })
            })
        };
        let before = potential(&self.system, &self.state);
        change(&mut self.system.forces);
        self.state.work.external += potential(&self.system, &self.state) - before;
    }
}

/// Number of steps of h in a frame.
///
/// # Errors
/// If they do not fill it, to a billionth of a step (a frame is a quotient of two numbers a user typed).
fn steps_in(frame: f64, h: f64) -> Result<usize, SettingsError> {
    let steps = (frame / h).round();
    if steps >= 1.0 && (frame / h - steps).abs() <= 1e-9 * steps {
        Ok(steps as usize)
    } else {
        Err(SettingsError::FrameNotMultiple { frame, h })
    }
}
