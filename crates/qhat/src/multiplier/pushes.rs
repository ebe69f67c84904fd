//! Change of velocity or acceleration by λ and F, and their power.
//!
//! ```text
//! W (Jᵀλ + F)        change of q̇ by impulses, or q̈ by forces        d·n numbers
//! J W (Jᵀλ + F)      change of Ċ, or C̈, in one row
//! ```

use super::{Equation, reaction};
use crate::energy;
use crate::settings::Feedback;
use crate::system::System;

impl Equation {
    /// W (Jᵀλ + F) for λ and F at hand.
    pub(crate) fn write_W_JT_lambda_F<const D: usize>(&mut self, system: &System) {
        self.write_W_JT_lambda::<D>(system);
        if !self.sliding.is_empty() {
            reaction::add_accelerations::<D>(&system.inverse_mass, &self.friction.force, &mut self.W_JT_lambda);
        }
    }

    /// W Jᵀλ for λ at hand.
    pub(crate) fn write_W_JT_lambda<const D: usize>(&mut self, system: &System) {
        self.Q_hat.fill(0.0);
        self.rows.J.add_transposed::<D>(&self.lambda, &mut self.Q_hat);
        self.W_JT_lambda.clear();
        self.W_JT_lambda.resize(system.coordinate_count(), 0.0);
        reaction::add_accelerations::<D>(&system.inverse_mass, &self.Q_hat, &mut self.W_JT_lambda);
    }

    /// J W Jᵀλ, or J W (Jᵀλ + F), in one row, as written last.
    pub(crate) fn J_W_JT_lambda<const D: usize>(&self, row: usize) -> f64 {
        self.rows.J.multiply_row::<D>(row, &self.W_JT_lambda)
    }

    /// λ ← 1 in a row that the factor at hand leaves out, and in the rows that it holds the λ under which J W Jᵀλ is
    /// zero there. W Jᵀλ is to be written anew.
    pub(crate) fn answer_to_row<const D: usize>(&mut self, system: &System, row: usize) {
        self.lambda.fill(0.0);
        self.lambda[row] = 1.0;
        self.write_W_JT_lambda::<D>(system);
        let target: Vec<f64> = (0..system.all_row_count()).map(|row| -self.J_W_JT_lambda::<D>(row)).collect();
        self.solver.solve(&system.matrix, &target, &mut self.lambda);
        self.lambda[row] += 1.0;
    }

    /// Power of driven constraints, for λ as solved last [W].
    pub(crate) fn drive_power(&self, system: &System, feedback: &Feedback) -> f64 {
        (1.0 - feedback.elasticity) * energy::drive_power(system, &self.rows.Ct, &self.lambda)
    }

    /// Power of the friction of sliding contacts, for λ as solved last [W].
    pub(crate) fn friction_power(&self, qd: &[f64]) -> f64 {
        if self.sliding.is_empty() {
            return 0.0;
        }
        self.friction.force.iter().zip(qd).map(|(force, velocity)| force * velocity).sum()
    }
}
