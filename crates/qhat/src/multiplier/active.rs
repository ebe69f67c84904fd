//! The active set: which rows are part of A λ = b, and the rows evaluated under it.
//!
//! Inactive rows stay in A, so that its structure and order of elimination are those of the System. Their scale is zero
//! (`factor.rs`), so they have λ = 0 and couple with nothing.

use super::{Equation, Sliding};
use crate::modes::{Mode, Modes};
use crate::point::Motion;
use crate::state::State;
use crate::system::System;

impl Equation {
    /// Takes the active rows and the sliding contacts from the modes. Nothing is factored for them yet.
    pub(crate) fn set_modes(&mut self, system: &System, modes: &Modes) {
        modes.write_inactive(&system.contacts, &mut self.inactive);
        self.broken.clone_from(&modes.broken);
        self.sliding.clear();
        for (k, (contact, mode)) in system.contacts.list.iter().zip(&modes.contacts).enumerate() {
            if let Mode::Sliding(slip) = *mode {
                let (normal, tangents, friction) = (contact.normal, contact.tangents.clone(), contact.friction);
                self.sliding.push(Sliding { contact: k, normal, tangents, friction, slip });
            }
        }
    }

    /// Takes the feet of beads from a state.
    pub(crate) fn place_feet<const D: usize>(&mut self, system: &System, state: &State) {
        if !system.bead_places.is_empty() {
            let motion = Motion::<D> { q: &state.q, qd: &state.qd, t: state.t };
            self.rows.feet.place(&system.beads(), motion, &state.feet);
        }
    }

    /// Moves the feet of beads on to a motion that was kept, and writes them to the state.
    pub(crate) fn follow_feet<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>, feet: &mut Vec<f64>) {
        system.follow_feet(&mut self.rows, motion, feet);
    }

    /// Whether a row is inactive now.
    pub(crate) fn is_inactive(&self, row: usize) -> bool {
        self.inactive.get(row).is_some_and(|inactive| *inactive)
    }

    /// Whether a row is left out of the factor at hand because it follows from other active rows.
    pub(crate) fn is_left_out(&self, row: usize) -> bool {
        self.solver.dependent().binary_search(&(row as u32)).is_ok()
    }

    /// C, Ċ, J and γ, with zeros for C, Ċ and γ of inactive rows; directions of friction go on with the motion.
    pub(crate) fn constrain<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        self.constrain_all(system, motion);
        if self.inactive.is_empty() {
            return;
        }
        for contact in self.sliding.iter_mut().filter(|contact| contact.tangents.len() == 2) {
            let row = contact.tangents.start;
            contact.slip.go_on([self.rows.Cd[row], self.rows.Cd[row + 1]], motion.t);
        }
        self.gaps.C.clone_from(&self.rows.C);
        self.gaps.Cd.clone_from(&self.rows.Cd);
        for row in (0..self.inactive.len()).filter(|&row| self.inactive[row]) {
            (self.rows.C[row], self.rows.Cd[row], self.rows.gamma[row]) = (0.0, 0.0, 0.0);
        }
    }

    /// C, Ċ, J and γ of every row, active or not.
    pub(crate) fn constrain_all<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        system.evaluate_rows(motion, &mut self.rows);
    }
}
