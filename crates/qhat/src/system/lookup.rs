//! Ids of a System: by name, by place, and all of them.

use super::System;
use crate::constraint::NamedConstraint;
use crate::space::{ConstraintId, ForceId, ParticleId};

impl System {
    /// The particle with a name. The search takes time in proportion to the number of particles.
    pub fn particle(&self, name: &str) -> Option<ParticleId> {
        self.particle_names.iter().position(|other| other == name).map(ParticleId)
    }

    /// The constraint with a name. The search takes time in proportion to the number of constraints.
    pub fn constraint(&self, name: &str) -> Option<ConstraintId> {
        self.constraints().iter().position(|named| named.name == name).map(ConstraintId)
    }

    /// The force that was added under a name by [`SystemBuilder::named_force`](crate::SystemBuilder::named_force).
    pub fn force(&self, name: &str) -> Option<ForceId> {
        self.force_names.iter().position(|other| other.as_deref() == Some(name)).map(ForceId)
    }

    /// All particles, in the order of addition.
    pub fn particles(&self) -> impl Iterator<Item = ParticleId> + use<> {
        (0..self.particle_count()).map(ParticleId)
    }

    /// The particle at a place in the order of addition, from 0.
    pub fn particle_at(&self, index: usize) -> Option<ParticleId> {
        (index < self.particle_count()).then_some(ParticleId(index))
    }

    /// The constraint at a place in the order of addition, from 0.
    pub fn constraint_at(&self, index: usize) -> Option<ConstraintId> {
        (index < self.constraints().len()).then_some(ConstraintId(index))
    }

    /// The names of the forces of the builder, in the order of addition: that under which a force was added, else its
    /// kind and its place from 0, as in `Spring 3`.
    pub fn force_names(&self) -> Vec<String> {
        let named = self.force_names.iter().zip(&self.forces).enumerate();
        named.map(|(k, (name, force))| name.clone().unwrap_or_else(|| format!("{} {k}", force.kind()))).collect()
    }

    /// The force at a place in the order of addition to the builder, from 0.
    pub fn force_at(&self, index: usize) -> Option<ForceId> {
        (index < self.force_names.len()).then_some(ForceId(index))
    }

    /// The constraint with an id.
    ///
    /// # Panics
    /// If the id is that of another system and this one has no constraint with its number.
    pub fn constraint_of(&self, id: ConstraintId) -> &NamedConstraint {
        &self.constraints[id.0]
    }
}
