//! What a System is made from, and the checks that it is one.

use super::{Particle, System};
use crate::constraint::Layout;
use crate::constraint::{Constraint, Holds};
use crate::error::BuildError;
use crate::force::{Acts, Force};
use crate::modes::Modes;
use crate::point::{block, minus, norm};
use crate::settings::Feedback;
use crate::space::{Dimension, ParticleId, in_dimension};
use crate::state::State;
use crate::structure::{Contacts, MatrixStructure};
use std::collections::HashSet;

/// A factor that would take more is refused [bytes]: 16 GiB, above what computers that show such scenes have to spare.
const MEMORY_LIMIT: u64 = 16 << 30;

/// Collects particles, constraints and forces and checks them in [`SystemBuilder::build`].
#[derive(Clone, Debug)]
pub struct SystemBuilder {
    dimension: Dimension,
    particles: Vec<Particle>,
    constraints: Vec<(String, Constraint)>,
    forces: Vec<Force>,
    feedback: Feedback,
}

impl SystemBuilder {
    pub(super) fn new(dimension: Dimension) -> Self {
        SystemBuilder {
            dimension,
            particles: Vec::new(),
            constraints: Vec::new(),
            forces: Vec::new(),
            feedback: Feedback::NONE,
        }
    }

    /// Adds a particle; its id is its place.
    pub fn particle(&mut self, particle: Particle) -> ParticleId {
        self.particles.push(particle);
        ParticleId(self.particles.len() - 1)
    }

    /// m [kg] of a particle that was added.
    ///
    /// # Panics
    /// Where there is none with this id.
    pub fn mass(&self, particle: ParticleId) -> f64 {
        self.particles[particle.0].mass
    }

    /// The name of a particle that was added.
    ///
    /// # Panics
    /// Where there is none with this id.
    pub fn name(&self, particle: ParticleId) -> &str {
        &self.particles[particle.0].name
    }

    /// Adds a constraint under a name that reports will use.
    pub fn constraint(&mut self, name: impl Into<String>, constraint: impl Into<Constraint>) -> &mut Self {
        self.constraints.push((name.into(), constraint.into()));
        self
    }

    /// Adds a force.
    pub fn force(&mut self, force: impl Into<Force>) -> &mut Self {
        self.forces.push(force.into());
        self
    }

    /// Sets ks, kd, diagonal drag and elasticity (all off by default).
    pub fn feedback(&mut self, feedback: Feedback) -> &mut Self {
        self.feedback = feedback;
        self
    }

    /// The system and the state it starts from.
    ///
    /// # Errors
    /// A name used twice, a number that is not finite or not allowed, a particle of the wrong dimension or that does not
    /// exist, a fixed particle that moves, so many constraints so closely connected that their factor would not fit.
    pub fn build(self) -> Result<(System, State), BuildError> {
        self.check()?;
        let q: Vec<f64> = self.particles.iter().flat_map(|particle| particle.position.iter().copied()).collect();
        let qd: Vec<f64> = self.particles.iter().flat_map(|particle| particle.velocity.iter().copied()).collect();
        let extent = in_dimension!(self.dimension, D => extent::<D>(&self.constraints, &q));
        let mut system = System {
            dimension: self.dimension,
            mass: self.particles.iter().map(|particle| particle.mass).collect(),
            inverse_mass: self.particles.iter().map(|p| if p.fixed { 0.0 } else { 1.0 / p.mass }).collect(),
            particle_names: self.particles.into_iter().map(|particle| particle.name).collect(),
            constraints: Vec::new(),
            row_names: Vec::new(),
            row_scale: Vec::new(),
            softness: Vec::new(),
            layout: Layout::default(),
            matrix: MatrixStructure::default(),
            chains: None,
            forces: self.forces,
            compliant: Vec::new(),
            feedback: self.feedback,
            extent,
            contacts: Contacts::default(),
        };
        system.set_constraints(self.constraints);
        let plan = system.plan_matrix();
        if plan.memory() > MEMORY_LIMIT {
            return Err(BuildError::TooLarge { memory: plan.memory(), limit: MEMORY_LIMIT });
        }
        system.matrix = MatrixStructure::new(&system.layout, &system.inverse_mass, plan);
        let state = State { modes: Modes::at_first(&system.contacts), ..State::new(q, qd) };
        Ok((system, state))
    }

    fn check(&self) -> Result<(), BuildError> {
        let mut names = HashSet::new();
        for particle in &self.particles {
            let wrong = |message: String| BuildError::Particle { name: particle.name.clone(), message };
            if !names.insert(&particle.name) {
                return Err(wrong("the name is used twice".into()));
            }
            let d = self.dimension.number();
            if particle.position.len() != d || particle.velocity.len() != d {
                return Err(wrong(format!("position and velocity must have {d} components")));
            }
            if !particle.position.iter().chain(&particle.velocity).all(|x| x.is_finite()) {
                return Err(wrong("position and velocity must be finite numbers".into()));
            }
            if !(particle.mass.is_finite() && particle.mass > 0.0 && (1.0 / particle.mass).is_finite()) {
                return Err(wrong(format!("the mass must be positive and finite, but is {:?} kg", particle.mass)));
            }
            if particle.fixed && particle.velocity.iter().any(|&v| v != 0.0) {
                return Err(wrong("a fixed particle cannot have a velocity".into()));
            }
        }
        let exists = |ids: Vec<ParticleId>| match ids.into_iter().find(|id| id.0 >= self.particles.len()) {
            Some(id) => Err(format!("there is no particle number {}", id.0)),
            None => Ok(()),
        };
        let fits = |wanted: Option<usize>| match wanted.filter(|d| *d != self.dimension.number()) {
            Some(d) => Err(format!("it is written for {d} dimensions, but the system has {}", self.dimension.number())),
            None => Ok(()),
        };
        for (name, constraint) in &self.constraints {
            let outcome = exists(constraint.particles()).and_then(|()| constraint.fits(self.dimension.number()));
            let outcome = outcome.and_then(|()| constraint.check());
            outcome.map_err(|message| BuildError::Constraint { name: name.clone(), message })?;
        }
        for (index, force) in self.forces.iter().enumerate() {
            let outcome = exists(force.particles()).and_then(|()| fits(force.dimension()));
            let outcome = outcome.and_then(|()| force.check());
            outcome.map_err(|message| BuildError::Force { index, message })?;
        }
        self.feedback.check()?;
        Ok(())
    }
}

/// The mean rod length, else the diagonal of the box around all particles, else 1 [m].
fn extent<const D: usize>(constraints: &[(String, Constraint)], q: &[f64]) -> f64 {
    let lengths = constraints.iter().filter_map(|(_, constraint)| Some(constraint.as_rod()?.length));
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    if count > 0.0 {
        return sum / count;
    }
    let mut low = [f64::INFINITY; D];
    let mut high = [f64::NEG_INFINITY; D];
    for i in 0..q.len() / D {
        let x = block::<D>(q, ParticleId(i));
        low = std::array::from_fn(|k| low[k].min(x[k]));
        high = std::array::from_fn(|k| high[k].max(x[k]));
    }
    let diagonal = norm(minus(high, low));
    if diagonal.is_finite() && diagonal > 0.0 { diagonal } else { 1.0 }
}
