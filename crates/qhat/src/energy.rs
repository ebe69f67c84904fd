//! The energy account of a motion.
//!
//! ```text
//! T = ½ Σ m_i v_i·v_i over the particles that can move,   V = Σ of the forces' potentials     [J]
//! missing = T + V − (T + V at t = 0) − work of everything that crossed the border
//! ```

use crate::error::StepError;
use crate::force::Acts;
use crate::point::{Motion, block, dot, norm};
use crate::space::{ParticleId, in_dimension};
use crate::state::{State, Work};
use crate::system::System;

/// The energy account \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Energy {
    /// T.
    pub kinetic: f64,
    /// V, over all forces that have a potential.
    pub potential: f64,
    /// The energy that has crossed the border of the system since t = 0.
    pub work: Work,
}

impl Energy {
    /// T + V.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential
    }

    /// T + V minus the work that came in: constant for an exact integrator.
    pub fn balance(&self) -> f64 {
        self.total() - self.work.total()
    }
}

/// The energy account of a state.
pub(crate) fn energy(system: &System, state: &State) -> Energy {
    in_dimension!(system.dimension, D => {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        let potential = potential(system, motion, &state.modes.broken);
        Energy { kinetic: kinetic(system, motion), potential, work: state.work }
    })
}

/// Refuses a motion whose kinetic or potential energy is not finite; t is that of the last good state [s]. `broken` as
/// in [`System::acting_forces`], here and below.
///
/// # Errors
/// [`StepError::EnergyNotFinite`] with the particle that has the largest part in it.
pub(crate) fn check_finite<const D: usize>(
    system: &System,
    motion: Motion<'_, D>,
    broken: &[bool],
    t: f64,
) -> Result<(), StepError> {
    let refused = |energy, particle: ParticleId| StepError::EnergyNotFinite {
        time: t,
        energy,
        particle: system.particle_names[particle.0].clone(),
    };
    if !kinetic(system, motion).is_finite() {
        let own = |i: ParticleId| system.mass[i.0] * dot(motion.v(i), motion.v(i));
        let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
        return largest_of(moving, own).map_or(Ok(()), |particle| Err(refused("kinetic", particle)));
    }
    for force in system.acting_forces(broken) {
        if !force.potential(motion, &system.mass).is_finite() {
            let concerned = force.particles();
            let concerned = if concerned.is_empty() { system.particles().collect() } else { concerned };
            // A force between particles has one potential, and the particle that is farthest out has the largest part.
            let own = |i: ParticleId| system.mass[i.0] * norm(motion.x(i));
            return largest_of(concerned.into_iter(), own)
                .map_or(Ok(()), |particle| Err(refused("potential", particle)));
        }
    }
    Ok(())
}

/// The particle with the largest number; one whose number is not finite counts as the largest.
fn largest_of(particles: impl Iterator<Item = ParticleId>, number: impl Fn(ParticleId) -> f64) -> Option<ParticleId> {
    let size = |i: ParticleId| Some(number(i)).filter(|number| number.is_finite()).unwrap_or(f64::INFINITY);
    particles.reduce(|best, next| if size(next) > size(best) { next } else { best })
}

/// The free particle with the largest acceleration under the applied forces, and that acceleration [m/s²].
pub(crate) fn most_accelerated<const D: usize>(
    system: &System,
    motion: Motion<'_, D>,
    broken: &[bool],
) -> Option<(ParticleId, f64)> {
    let mut Q = vec![0.0; system.coordinate_count()];
    system.add_forces(motion, broken, &mut Q);
    let size = |i: ParticleId| system.inverse_mass[i.0] * norm(block::<D>(&Q, i));
    let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
    largest_of(moving, size).map(|particle| (particle, size(particle)))
}

fn kinetic<const D: usize>(system: &System, motion: Motion<'_, D>) -> f64 {
    let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
    0.5 * moving.map(|i| system.mass[i.0] * dot(motion.v(i), motion.v(i))).sum::<f64>()
}

pub(crate) fn potential<const D: usize>(system: &System, motion: Motion<'_, D>, broken: &[bool]) -> f64 {
    system.acting_forces(broken).map(|force| force.potential(motion, &system.mass)).sum()
}

/// Power of all forces without a potential [W].
pub(crate) fn dissipation<const D: usize>(system: &System, motion: Motion<'_, D>, broken: &[bool]) -> f64 {
    system.acting_forces(broken).map(|force| force.power(motion)).sum()
}

/// Power of the drives [W]: −λᵀ C_t over the rigid rows. The constraint force has the power Jᵀλ·q̇ = λᵀ (Ċ − C_t), and
/// Ċ = 0 on legal motion.
pub(crate) fn drive_power(system: &System, Ct: &[f64], lambda: &[f64]) -> f64 {
    let mut power = 0.0;
    // In most systems no row depends on t, and one sum without branches shows it.
    if !Ct.iter().fold(false, |moves, &Ct| moves | (Ct != 0.0)) {
        return power;
    }
    for (row, &Ct) in Ct.iter().enumerate() {
        // A compliant row acts as a force: its λ is reported, but the work is that of the force.
        if Ct != 0.0 && system.softness[row].is_rigid() {
            power -= lambda[row] * Ct;
        }
    }
    power
}

/// The work the applied forces could do over the length of the system [J]: a scale for energies that has no zero point.
pub(crate) fn energy_scale(system: &System, state: &State) -> f64 {
    let mut Q = vec![0.0; system.coordinate_count()];
    in_dimension!(system.dimension, D => {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        system.add_forces(motion, &state.modes.broken, &mut Q);
        let moving = (0..system.particle_count()).map(ParticleId).filter(|&i| !system.is_fixed(i));
        system.extent * moving.map(|i| norm(block::<D>(&Q, i))).sum::<f64>()
    })
}
