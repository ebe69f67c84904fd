//! The equation: from a motion to λ, Q̂ and q̈.
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ,   Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```
//!
//! The friction F of sliding contacts follows λ and is added to both: −J W F to the right-hand side, W F to q̈
//! (`friction.rs`). Readers see F as multipliers of tangential rows and as a part of Q̂. A soft row is inert: its force
//! is part of Q, and λ only reports it.

use super::{Equation, SolveFor, reaction};
use crate::point::Motion;
use crate::settings::Feedback;
use crate::system::System;

impl Equation {
    /// Solves the equation at one motion, everything from Q to q̈. `is_factored`: the factor of A + ε I at this q and
    /// t is at hand, and no new one is made.
    pub(crate) fn solve<const D: usize>(
        &mut self,
        system: &System,
        motion: Motion<'_, D>,
        feedback: &Feedback,
        is_factored: bool,
        wanted: SolveFor,
    ) {
        let (W, s) = (&system.inverse_mass, 1.0 - feedback.elasticity);
        self.apply_forces(system, motion); // Q, W Q
        self.constrain(system, motion); // C, Ċ, J, γ
        self.b.assemble::<D>(&self.rows, &self.WQ, feedback); // b = −γ − J W Q − ks C − kd Ċ
        if !is_factored {
            self.factor::<D>(system, feedback.diagonal_drag); // A + ε I
        }
        self.solve_multipliers::<D>(system, wanted); // (A + ε I) λ = b, and F
        reaction::constraint_forces::<D>(&self.rows.J, &self.lambda, s, &mut self.Q_hat); // Q̂ = s Jᵀ λ
        self.report_soft_rows(system); // λ of soft rows
        reaction::accelerations::<D>(W, &self.Q, &self.Q_hat, &mut self.qdd); // q̈ = W (Q + Q̂)
        if !self.sliding.is_empty() {
            reaction::add_accelerations::<D>(W, &self.friction.force, &mut self.qdd); // q̈ += W F
        }
    }

    /// Adds the friction of sliding contacts to λ and Q̂ of an equation that is solved, as sticking contacts have it:
    /// so terms and outputs show it, and their forces add up to M q̈.
    pub(crate) fn show_friction(&mut self) {
        for contact in &self.sliding {
            contact.write_multipliers(&mut self.lambda);
        }
        if !self.sliding.is_empty() {
            self.Q_hat.iter_mut().zip(&self.friction.force).for_each(|(held, friction)| *held += friction);
        }
    }

    /// Q and W Q.
    pub(crate) fn apply_forces<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        system.add_forces(motion, &mut self.Q);
        for (i, &w) in system.inverse_mass.iter().enumerate() {
            for k in i * D..(i + 1) * D {
                self.WQ[k] = w * self.Q[k];
            }
        }
    }

    /// A = J W Jᵀ and the factor of A + ε I, over the active rows.
    pub(crate) fn factor<const D: usize>(&mut self, system: &System, epsilon: f64) {
        system.matrix.assemble::<D>(&self.rows.J, &system.inverse_mass, &mut self.A);
        self.solver.factor(&system.matrix, &self.A, epsilon, &self.inactive);
    }

    /// λ for the right-hand side at hand, and F of the sliding contacts; λ is not a number where friction has no
    /// answer.
    pub(crate) fn solve_multipliers<const D: usize>(&mut self, system: &System, wanted: SolveFor) {
        let Equation { sliding, friction, rows, b, lambda, solver, .. } = self;
        solver.solve(&system.matrix, &b.sum, wanted, lambda);
        if !sliding.is_empty() {
            friction.solve::<D>(sliding, rows, &system.inverse_mass, lambda, |target, answer| {
                solver.solve(&system.matrix, target, wanted, answer);
            });
        }
    }

    /// λ = −(C/α + c Ċ) of soft rows.
    fn report_soft_rows(&mut self, system: &System) {
        for (row, soft) in system.softness.iter().enumerate().filter(|(_, soft)| !soft.is_rigid()) {
            self.lambda[row] = -(self.rows.C[row] / soft.compliance + soft.damping * self.rows.Cd[row]);
        }
    }
}
