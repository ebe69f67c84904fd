//! The builder of a System: collects particles, constraints and forces, and checks them.

use super::parameters::Parameters;
use super::{BuildError, Particle, ParticleError, System};
use crate::constraint::{Constraint, ConstraintError, Holds, Layout};
use crate::expression::{Expression, ExpressionError, Purpose, Scope};
use crate::force::{Acts, Force, ForceError};
use crate::point::{block, minus, norm};
use crate::settings::Feedback;
use crate::space::{ConstraintId, Dimension, ForceId, ParticleId, in_dimension};
use crate::state::State;
use crate::structure::{Contacts, MatrixStructure};
use std::collections::{BTreeMap, HashSet};
use std::sync::OnceLock;

/// The largest factor of A that is accepted [bytes]: 2 GiB. The largest net of a scene, 1000 × 1000, takes about 1.2
/// GiB (316 × 316: 92 MB). A run keeps a second factor for the tensions, and the page has 4 GiB in all.
const MEMORY_LIMIT: u64 = 2 << 30;

/// Collects particles, constraints and forces and checks them in [`SystemBuilder::build`].
#[derive(Clone, Debug)]
pub struct SystemBuilder {
    dimension: Dimension,
    pub(super) particles: Vec<Particle>,
    pub(super) constraints: Vec<(String, Constraint)>,
    pub(super) forces: Vec<(Option<String>, Force)>,
    pub(super) feedback: Feedback,
    pub(super) parameters: Parameters,
    /// The particles by name, from the first expression on.
    names: OnceLock<BTreeMap<String, ParticleId>>,
}

impl SystemBuilder {
    pub(super) fn new(dimension: Dimension) -> Self {
        SystemBuilder {
            dimension,
            particles: Vec::new(),
            constraints: Vec::new(),
            forces: Vec::new(),
            feedback: Feedback::NONE,
            parameters: Parameters::default(),
            names: OnceLock::new(),
        }
    }

    /// Adds a particle; its id is its place.
    pub fn particle(&mut self, particle: Particle) -> ParticleId {
        let id = ParticleId(self.particles.len());
        if let Some(names) = self.names.get_mut() {
            names.entry(particle.name.clone()).or_insert(id);
        }
        self.particles.push(particle);
        id
    }

    /// m \[kg\] of a particle that was added.
    ///
    /// # Panics
    /// If no particle was added under this id.
    pub fn mass(&self, particle: ParticleId) -> f64 {
        self.particles[particle.0].mass
    }

    /// The name of a particle that was added.
    ///
    /// # Panics
    /// If no particle was added under this id.
    pub fn name(&self, particle: ParticleId) -> &str {
        &self.particles[particle.0].name
    }

    /// Adds a constraint under a name, which reports use and which no other constraint has.
    pub fn constraint(&mut self, name: impl Into<String>, constraint: impl Into<Constraint>) -> ConstraintId {
        self.constraints.push((name.into(), constraint.into()));
        ConstraintId(self.constraints.len() - 1)
    }

    /// Adds a force.
    pub fn force(&mut self, force: impl Into<Force>) -> ForceId {
        self.add_force(None, force.into())
    }

    /// Adds a force under a name, by which [`System::force`] finds it and which no other force has.
    pub fn named_force(&mut self, name: impl Into<String>, force: impl Into<Force>) -> ForceId {
        self.add_force(Some(name.into()), force.into())
    }

    fn add_force(&mut self, name: Option<String>, force: Force) -> ForceId {
        self.forces.push((name, force));
        ForceId(self.forces.len() - 1)
    }

    /// Adds a particle, for a chain of calls; [`SystemBuilder::particle`] gives its id.
    pub fn with_particle(&mut self, particle: Particle) -> &mut Self {
        self.particle(particle);
        self
    }

    /// Adds a constraint, for a chain of calls; [`SystemBuilder::constraint`] gives its id.
    pub fn with_constraint(&mut self, name: impl Into<String>, constraint: impl Into<Constraint>) -> &mut Self {
        self.constraint(name, constraint);
        self
    }

    /// Adds a force, for a chain of calls; [`SystemBuilder::force`] gives its id.
    pub fn with_force(&mut self, force: impl Into<Force>) -> &mut Self {
        self.force(force);
        self
    }

    /// The id of the particle at a place in the order of addition, from 0.
    pub fn particle_at(&self, index: usize) -> Option<ParticleId> {
        (index < self.particles.len()).then_some(ParticleId(index))
    }

    /// The id of the constraint at a place in the order of addition, from 0.
    pub fn constraint_at(&self, index: usize) -> Option<ConstraintId> {
        (index < self.constraints.len()).then_some(ConstraintId(index))
    }

    /// The id of the force at a place in the order of addition, from 0.
    pub fn force_at(&self, index: usize) -> Option<ForceId> {
        (index < self.forces.len()).then_some(ForceId(index))
    }

    /// The number of constraints that were added.
    pub fn constraint_count(&self) -> usize {
        self.constraints.len()
    }

    /// The number of forces that were added.
    pub fn force_count(&self) -> usize {
        self.forces.len()
    }

    /// An expression in the names of the particles that were added so far.
    ///
    /// # Errors
    /// As [`Expression::parse`].
    pub fn expression(&self, purpose: Purpose, text: &str) -> Result<Expression, ExpressionError> {
        let names = self.names.get_or_init(|| {
            // Of two particles with one name, which `build` refuses, the first counts.
            let names = self.particles.iter().enumerate().rev();
            names.map(|(place, particle)| (particle.name.clone(), ParticleId(place))).collect()
        });
        Expression::parse(text, &Scope::new(purpose, self.dimension, &|name| names.get(name).copied()))
    }

    /// Sets ks, kd, diagonal drag and elasticity (all off by default).
    pub fn feedback(&mut self, feedback: Feedback) -> &mut Self {
        self.feedback = feedback;
        self
    }

    /// The system and the state it starts from. The builder stays as it is, and can be changed and built again.
    ///
    /// ```
    /// use qhat::{Dimension, Gravity, Particle, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let (system, state) = builder
    ///     .with_particle(Particle::at("stone", [0.0, 10.0]))
    ///     .with_force(Gravity { acceleration: [0.0, -9.81, 0.0] })
    ///     .build()?;
    /// assert_eq!(system.particle("stone").map(|stone| stone.index()), Some(0));
    /// # Ok::<(), qhat::BuildError>(())
    /// ```
    ///
    /// # Errors
    /// A name used twice, a number that is not finite or not allowed, a particle of the wrong dimension or that does
    /// not exist, a fixed particle that moves, so many constraints so closely connected that their factor would not
    /// fit.
    pub fn build(&self) -> Result<(System, State), BuildError> {
        self.check()?;
        let q: Vec<f64> = self.particles.iter().flat_map(|particle| particle.position.iter().copied()).collect();
        let qd: Vec<f64> = self.particles.iter().flat_map(|particle| particle.velocity.iter().copied()).collect();
        let constraints = self.constraints.iter().map(|(_, constraint)| constraint);
        let extent = in_dimension!(self.dimension, D => extent::<D>(constraints, &q));
        let mut parameters = self.parameters.clone();
        parameters.before.reserve(parameters.uses.len());
        let values: Vec<f64> = parameters.list.iter().map(|parameter| parameter.value).collect();
        let mut system = System {
            dimension: self.dimension,
            mass: self.particles.iter().map(|particle| particle.mass).collect(),
            inverse_mass: self.particles.iter().map(|p| if p.fixed { 0.0 } else { 1.0 / p.mass }).collect(),
            particle_names: self.particles.iter().map(|particle| particle.name.clone()).collect(),
            constraints: Vec::new(),
            row_names: Vec::new(),
            row_scale: Vec::new(),
            softness: Vec::new(),
            layout: Layout::default(),
            matrix: MatrixStructure::default(),
            chains: None,
            forces: self.forces.iter().map(|(_, force)| force.clone()).collect(),
            force_names: self.forces.iter().map(|(name, _)| name.clone()).collect(),
            compliant: Vec::new(),
            feedback: self.feedback,
            extent,
            parameters,
            start_q: q,
            start_qd: qd,
            contacts: Contacts::default(),
            second_order: Vec::new(),
            second_order_rods: Vec::new(),
            following_rods: Vec::new(),
            following: Vec::new(),
            given: self.constraints.len(),
            jumpy: Vec::new(),
            bead_places: Vec::new(),
        };
        system.set_constraints(self.constraints.clone());
        let plan = system.plan_matrix();
        if plan.memory() > MEMORY_LIMIT {
            let (first_row, rows) = plan.largest().unwrap_or_default();
            let before = system.constraints.partition_point(|named| named.first_row <= first_row);
            let constraint = system.constraints[before.saturating_sub(1)].name.clone();
            return Err(BuildError::TooLarge { constraint, rows, memory: plan.memory(), limit: MEMORY_LIMIT });
        }
        system.matrix = MatrixStructure::new(&system.layout, &system.inverse_mass, plan);
        system.bind(&values)?;
        let state = system.start();
        Ok((system, state))
    }

    fn check(&self) -> Result<(), BuildError> {
        let mut names = HashSet::new();
        for particle in &self.particles {
            let taken = if names.insert(&particle.name) { Ok(()) } else { Err(ParticleError::NameTaken) };
            let refused = |reason| BuildError::Particle { name: particle.name.clone(), reason };
            taken.and_then(|()| particle.check(self.dimension.number())).map_err(refused)?;
        }
        let mut names = HashSet::new();
        for (name, constraint) in &self.constraints {
            let taken = if names.insert(name) { Ok(()) } else { Err(ConstraintError::NameTaken) };
            let refused = |reason| BuildError::Constraint { name: name.clone(), reason };
            taken.and_then(|()| self.check_constraint(constraint)).map_err(refused)?;
        }
        let mut names = HashSet::new();
        for (index, (name, force)) in self.forces.iter().enumerate() {
            let is_new = name.as_ref().is_none_or(|name| names.insert(name));
            let taken = if is_new { Ok(()) } else { Err(ForceError::NameTaken) };
            let fits = || check_force(force, self.dimension, self.particles.len());
            let refused = |reason| BuildError::Force { name: name.clone(), index, reason };
            taken.and_then(|()| fits()).map_err(refused)?;
        }
        self.feedback.check()?;
        Ok(())
    }

    fn check_constraint(&self, constraint: &Constraint) -> Result<(), ConstraintError> {
        if let Some(id) = constraint.particles().into_iter().find(|id| id.0 >= self.particles.len()) {
            return Err(ConstraintError::NoParticle { particle: id.0 });
        }
        constraint.fits(self.dimension.number())?;
        constraint.check()
    }
}

/// `Ok` if a force can act in a system with so many dimensions and particles.
pub(crate) fn check_force(force: &Force, dimension: Dimension, particles: usize) -> Result<(), ForceError> {
    if let Some(id) = force.particles().into_iter().find(|id| id.0 >= particles) {
        return Err(ForceError::NoParticle { particle: id.0 });
    }
    let dimension = dimension.number();
    if let Some(wanted) = force.dimension().filter(|&wanted| wanted != dimension) {
        return Err(ForceError::Dimension { wanted, dimension });
    }
    force.check()
}

/// The mean rod length, else the diagonal of the box around all particles, else 1 [m].
pub(super) fn extent<'a, const D: usize>(constraints: impl Iterator<Item = &'a Constraint>, q: &[f64]) -> f64 {
    let lengths = constraints.filter_map(|constraint| Some(constraint.as_rod()?.length));
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
