//! A system whose rods hold some joints only to second order: the rows that hold them, behind those of the user.

use super::System;
use super::parameters::Parameters;
use crate::constraint::{Constraint, Relation};
use crate::space::{ConstraintId, ParticleId, in_dimension};
use crate::state::State;
use crate::structure::{FlatClique, Hold, MatrixStructure, flat_cliques, hold};

impl System {
    /// The same system with other constraints in place of the rods of some cliques.
    pub(crate) fn with_cliques(
        &self,
        cliques: &[FlatClique],
        stand_in: &dyn Fn(&FlatClique) -> Vec<Constraint>,
    ) -> System {
        let mut is_replaced = vec![false; self.given];
        cliques.iter().flat_map(|clique| &clique.rods).for_each(|rod| is_replaced[rod.0] = true);
        let kept = self.constraints.iter().zip(is_replaced).filter(|(_, is_replaced)| !is_replaced);
        let kept = kept.map(|(named, _)| (named.name.clone(), named.constraint.clone()));
        let others = cliques.iter().flat_map(stand_in).map(|constraint| (String::new(), constraint));
        let constraints: Vec<_> = kept.chain(others).collect();
        let mut system = self.clone();
        // The uses name constraints by their places in this system.
        system.parameters = Parameters::default();
        (system.second_order, system.second_order_rods, system.following_rods) = Default::default();
        system.given = constraints.len();
        system.set_constraints(constraints);
        system.matrix = MatrixStructure::new(&system.layout, &system.inverse_mass, system.plan_matrix());
        system
    }

    /// Whether a constraint is a rod whose tension has no meaning, because it holds a joint only to second order.
    pub(crate) fn is_second_order(&self, constraint: usize) -> bool {
        self.second_order_rods.binary_search(&ConstraintId(constraint)).is_ok()
    }

    /// The rows of rods whose lengths follow from the rows that hold their cliques, ascending. They never act.
    pub(crate) fn following(&self) -> &[u32] {
        &self.following
    }

    /// Whether a row is held at C = 0 by its own λ: it is rigid, and does not follow from others everywhere.
    pub(crate) fn is_held(&self, row: usize) -> bool {
        self.softness[row].is_rigid() && !self.is_following(row)
    }

    /// Whether a row is one of `following`.
    pub(crate) fn is_following(&self, row: usize) -> bool {
        !self.following.is_empty() && self.following.binary_search(&(row as u32)).is_ok()
    }

    /// Holds cliques, whose particles are at q \[m\], by other rows than their rods, which hold them only to second
    /// order. Cliques that were held before are held by their rods alone again.
    pub(crate) fn set_second_order(&mut self, cliques: Vec<FlatClique>, q: &[f64]) {
        if cliques.is_empty() && self.second_order.is_empty() {
            return;
        }
        self.constraints.truncate(self.given);
        let Hold { relations, following } = in_dimension!(self.dimension, D => {
            hold::<D>(&self.constraints, &self.inverse_mass, &cliques, q)
        });
        let given = self.constraints.iter().map(|named| (named.name.clone(), named.constraint.clone()));
        let hidden = relations.into_iter().map(|relation| (self.name_of(&relation), relation.into()));
        let constraints = given.chain(hidden).collect();
        self.second_order_rods = cliques.iter().flat_map(|clique| clique.rods.iter().copied()).collect();
        self.second_order_rods.sort_unstable();
        (self.second_order, self.following_rods) = (cliques, following);
        self.set_constraints(constraints);
        self.matrix = MatrixStructure::new(&self.layout, &self.inverse_mass, self.plan_matrix());
    }

    /// A name for a joint of a clique among the corners: no constraint of the user has it.
    fn name_of(&self, relation: &Relation) -> String {
        let names: Vec<&str> = relation.terms.iter().map(|(id, _)| self.particle_names[id.0].as_str()).collect();
        match names[..] {
            [joint, a, b] => format!("{joint} on the line of {a} and {b}"),
            [joint, ref corners @ ..] => format!("{joint} in the plane of {}", corners.join(", ")),
            [] => String::new(),
        }
    }

    /// The flat cliques of the rods that are whole.
    pub(crate) fn flat_cliques(&self, state: &State) -> Vec<FlatClique> {
        let breakables = self.contacts.breakables.iter().zip(&state.modes.broken);
        // Breakables are in the order of constraints.
        let broken: Vec<usize> =
            breakables.filter(|&(_, &broken)| broken).map(|(breakable, _)| breakable.constraint).collect();
        let is_broken = |place: usize| broken.binary_search(&place).is_ok();
        in_dimension!(self.dimension, D => {
            flat_cliques::<D>(&self.constraints, &self.inverse_mass, &state.q, &is_broken)
        })
    }

    /// The names of the joints of the cliques that are held only to second order.
    pub(crate) fn names_of_cliques(&self) -> Vec<Vec<String>> {
        let name = |id: &ParticleId| self.particle_names[id.0].clone();
        self.second_order.iter().map(|clique| clique.particles.iter().map(name).collect()).collect()
    }
}
