//! λ and tensions as people read them: redundant rows share their force (`multiplier/share/`).
//!
//! A step needs the force Jᵀλ alone, so a share is made only where somebody reads λ: in terms, tensions, reactions and
//! the record of the largest tension. Systems with links that may break read it at the end of every substep.

use super::Workspace;
use crate::constraint::Holds;
use crate::multiplier::{Equation, Needed, RowsToShare, Share, Sticking};
use crate::point::Motion;
use crate::settings::Feedback;
use crate::space::in_dimension;
use crate::state::State;
use crate::structure::Contact;
use crate::system::System;

/// The arrays for the share of redundant rows; each list has one number for each row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading {
    share: Share,
    flexibility: Vec<f64>,
    acts: Vec<bool>,
    is_one_sided: Vec<bool>,
    sticking: Vec<Sticking>,
}

impl Workspace {
    /// Solves the equation at a state, with the share of redundant rows as λ; a factor of A that is at hand is kept.
    /// Q̂ and q̈ are those of the solve.
    pub(crate) fn solve<const D: usize>(&mut self, system: &System, state: &State, feedback: &Feedback) -> &Equation {
        let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
        self.set_modes(system, state);
        let is_factored = feedback.diagonal_drag == 0.0 && self.is_factored_at(state);
        self.equation.solve(system, motion, feedback, is_factored, Needed::Forces);
        self.equation.solver.memory.forget();
        if feedback.diagonal_drag == 0.0 {
            self.note_factored(state);
        }
        self.reading.share_out::<D>(system, state.t, feedback, &mut self.equation);
        self.equation.show_friction();
        &self.equation
    }

    /// For each row whether the λ that was read last is unique.
    pub(crate) fn multiplier_is_unique(&self) -> &[bool] {
        &self.reading.share.is_unique
    }

    /// Signed tension of every link at a state [N], as applied.
    pub(crate) fn tension(&mut self, system: &System, state: &State, feedback: &Feedback) -> Vec<f64> {
        in_dimension!(system.dimension, D => {
            let equation = self.solve::<D>(system, state, feedback);
            let (motion, s) = (Motion::<D> { q: &state.q, qd: &state.qd, t: state.t }, 1.0 - feedback.elasticity);
            let links = system.constraints.iter();
            let links = links.filter_map(|named| Some((named.constraint.as_link()?, named.first_row)));
            links.map(|(link, first_row)| link.tension(motion, &equation.lambda[first_row..], s)).collect()
        })
    }

    /// For each link whether the tension that was read last is unique.
    pub(crate) fn tension_is_unique(&self, system: &System) -> Vec<bool> {
        let is_unique = &self.reading.share.is_unique;
        system.links().map(|link| is_unique[link.rows].iter().all(|&is_unique| is_unique)).collect()
    }
}

impl Reading {
    /// λ ← the share of redundant rows, for an equation that was solved at t.
    pub(super) fn share_out<const D: usize>(
        &mut self,
        system: &System,
        t: f64,
        feedback: &Feedback,
        equation: &mut Equation,
    ) {
        // With diagonal drag A + ε I is regular, and its λ is unique.
        if !equation.solver.dependent().is_empty() && feedback.diagonal_drag == 0.0 {
            self.spread::<D>(system, t, equation);
        } else {
            self.share.set_unique(system.all_row_count());
        }
    }

    fn spread<const D: usize>(&mut self, system: &System, t: f64, equation: &mut Equation) {
        let Reading { share, flexibility, acts, is_one_sided, sticking } = self;
        flexibility.clear();
        for named in &system.constraints {
            let rows = 0..named.constraint.row_count(D);
            flexibility.extend(rows.map(|row| named.constraint.flexibility(row, t)));
        }
        let inert = &system.matrix.inert;
        acts.clear();
        acts.extend((0..system.all_row_count()).map(|row| !inert[row] && !equation.is_inactive(row)));
        is_one_sided.clear();
        is_one_sided.resize(system.all_row_count(), false);
        sticking.clear();
        for Contact { normal, tangents, friction, .. } in &system.contacts.list {
            is_one_sided[*normal] = true;
            // The tangential rows of a contact that sticks are active, and of no other.
            if tangents.clone().any(|row| !equation.is_inactive(row)) {
                sticking.push(Sticking { normal: *normal, tangents: tangents.clone(), friction: *friction });
            }
        }
        let lambda = equation.lambda.clone();
        equation.spread_over_contacts::<D>(system);
        let rows = RowsToShare {
            J: &equation.rows.J,
            inverse_mass: &system.inverse_mass,
            flexibility,
            acts,
            is_one_sided,
            sticking,
            lambda: &lambda,
            applied: &equation.Q,
            rates: &equation.b,
            sliding: &equation.sliding,
        };
        share.spread::<D>(&rows, |row| !inert[row], &mut equation.lambda);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dimension, Gravity, Limits, Particle, Settings, project};

    /// A taut rope and a slack one may have the same q: the factor of one must not serve the other.
    #[test]
    fn a_factor_is_not_kept_for_other_modes() {
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(2.0));
        builder
            .with_constraint("rope", Limits::rope(hook, bob, 1.0))
            .force(Gravity { acceleration: [0.0, -9.81, 0.0] });
        let (system, mut taut) = builder.build().unwrap();
        let mut workspace = Workspace::new(&system);
        project(&system, &mut taut, &Settings::default(), &mut workspace).unwrap();
        let slack = taut.with_motion(taut.positions().to_vec(), taut.velocities().to_vec());
        let tension = |workspace: &mut Workspace, state: &State| workspace.tension(&system, state, &Feedback::NONE);
        // The rope carries m g, to a few roundings of numbers of size 20.
        assert!((tension(&mut workspace, &taut)[0] - 2.0 * 9.81).abs() < 1e-13);
        assert_eq!(tension(&mut workspace, &slack), [0.0]);
        assert_eq!(tension(&mut workspace, &taut), tension(&mut Workspace::new(&system), &taut));
    }
}
