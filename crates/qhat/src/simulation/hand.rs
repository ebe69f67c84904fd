//! The hand: a mouse spring that pulls one particle between steps.

use super::Simulation;
use crate::force::{Force, ForceError, MouseSpring};
use crate::point::Vector;
use crate::space::ParticleId;

/// The frequency at which a grabbed particle follows the hand [rad/s]: two turns a second, quick to the eye and slow
/// against steps of a frame.
const FREQUENCY: f64 = 2.0 * std::f64::consts::PI * 2.0;
/// The damping of the hand, relative to critical damping [1].
const DAMPING_RATIO: f64 = 0.65;

impl Simulation {
    /// Takes hold of a particle with a mouse spring whose stiffness suits the mass that it pulls. A particle that was
    /// grabbed before is let go.
    ///
    /// # Errors
    /// A particle that does not exist or is fixed; a target that is not finite.
    pub fn grab(&mut self, particle: ParticleId, target: impl Into<Vector>) -> Result<(), ForceError> {
        if self.system.particle_at(particle.0).is_some_and(|particle| self.system.is_fixed(particle)) {
            return Err(ForceError::Fixed { particle: self.system.particle_names[particle.0].clone() });
        }
        let (stiffness, damping) = self.grip(particle);
        self.hold(MouseSpring { particle, target: target.into().0, stiffness, damping })
    }

    /// Moves the point that the mouse spring pulls to \[m\].
    ///
    /// # Errors
    /// No particle that is grabbed; a target that is not finite.
    pub fn drag_to(&mut self, target: impl Into<Vector>) -> Result<(), ForceError> {
        match self.mouse() {
            Some(mouse) => self.hold(MouseSpring { target: target.into().0, ..mouse.clone() }),
            None => Err(ForceError::NothingGrabbed),
        }
    }

    /// Lets go; nothing if no particle is grabbed.
    pub fn release(&mut self) {
        if let Some(place) = self.place_of_mouse() {
            self.change_forces(|forces| drop(forces.remove(place)));
        }
    }

    /// The mouse spring, if a particle is grabbed.
    pub fn mouse(&self) -> Option<&MouseSpring> {
        match &self.system.forces[self.place_of_mouse()?] {
            Force::MouseSpring(mouse) => Some(mouse),
            _ => None,
        }
    }

    fn hold(&mut self, mouse: MouseSpring) -> Result<(), ForceError> {
        let force = Force::from(mouse);
        self.check_force(&force)?;
        let place = self.place_of_mouse();
        self.change_forces(|forces| match place {
            Some(place) => forces[place] = force,
            None => forces.push(force),
        });
        Ok(())
    }

    /// The place of the hand among the forces: behind those of the builder, which keep their ids.
    fn place_of_mouse(&self) -> Option<usize> {
        let built = self.system.force_names.len();
        let added = self.system.forces[built..].iter();
        added.enumerate().find(|(_, force)| matches!(force, Force::MouseSpring(_))).map(|(place, _)| built + place)
    }

    /// Stiffness [N/m] and damping [N·s/m] of a mouse spring on a particle: the mass that hangs together with it
    /// follows the hand in about half a second.
    fn grip(&self, particle: ParticleId) -> (f64, f64) {
        let mass = self.system.connected_mass(particle);
        let (mut stiffness, mut damping) = (mass * FREQUENCY * FREQUENCY, 2.0 * DAMPING_RATIO * mass * FREQUENCY);
        if !self.settings.integrator.is_adaptive() && !self.settings.integrator.is_implicit() {
            // A light particle on a heavy body feels the whole spring; steps of a fixed h must remain stable for it
            // alone.
            let h = self.settings.h;
            let w = self.system.inverse_mass.get(particle.0).copied().unwrap_or(0.0);
            stiffness = stiffness.min(0.25 / (w * h * h));
            damping = damping.min(0.25 / (w * h));
        }
        (stiffness, damping)
    }
}
