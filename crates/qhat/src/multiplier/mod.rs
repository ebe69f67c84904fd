//! The equation: from a motion to λ, Q̂ and q̈.
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ,   Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```

mod factor;
mod matrix;
mod reaction;
mod rhs;
#[cfg(test)]
mod tests;

pub(crate) use factor::{MultiplierSolver, Multipliers};
pub(crate) use matrix::{MatrixPlan, MatrixStructure};
pub(crate) use rhs::RightHandSide;

use crate::constraint::Rows;
use crate::measure;
use crate::point::Motion;
use crate::report::Warning;
use crate::settings::Feedback;
use crate::system::System;

/// Every quantity of one evaluation, in arrays that are made once and written again.
#[derive(Clone, Debug)]
pub(crate) struct Equation {
    pub(crate) Q: Vec<f64>,
    pub(crate) WQ: Vec<f64>,
    pub(crate) rows: Rows,
    /// In the order of elimination.
    pub(crate) A: Vec<f64>,
    pub(crate) b: RightHandSide,
    pub(crate) solver: MultiplierSolver,
    pub(crate) lambda: Vec<f64>,
    pub(crate) Q_hat: Vec<f64>,
    pub(crate) qdd: Vec<f64>,
}

impl Equation {
    pub(crate) fn new(system: &System) -> Self {
        let (coordinates, m) = (system.coordinate_count(), system.row_count());
        Equation {
            Q: vec![0.0; coordinates],
            WQ: vec![0.0; coordinates],
            rows: system.empty_rows(),
            A: vec![0.0; system.matrix.pattern.len()],
            b: RightHandSide::new(m),
            solver: MultiplierSolver::new(&system.matrix),
            lambda: vec![0.0; m],
            Q_hat: vec![0.0; coordinates],
            qdd: vec![0.0; coordinates],
        }
    }

    /// Solves the equation at one motion: everything from Q to q̈. Where the factor of A + ε I at this q is at hand already,
    /// it is not made again.
    pub(crate) fn solve<const D: usize>(
        &mut self,
        system: &System,
        motion: Motion<'_, D>,
        feedback: &Feedback,
        is_factored: bool,
        wanted: Multipliers,
    ) {
        self.apply_forces(system, motion);
        self.constrain(system, motion);
        self.b.assemble::<D>(&self.rows, &self.WQ, feedback);
        if !is_factored {
            self.factor::<D>(system, feedback.diagonal_drag);
        }
        self.solver.solve(&system.matrix, &self.b.sum, wanted, &mut self.lambda);
        let s = 1.0 - feedback.elasticity;
        reaction::constraint_forces::<D>(&self.rows.J, &self.lambda, s, &mut self.Q_hat);
        // What gives way has acted in Q already; its λ is told all the same.
        for (row, soft) in system.softness.iter().enumerate().filter(|(_, soft)| !soft.is_rigid()) {
            self.lambda[row] = -(self.rows.C[row] / soft.compliance + soft.damping * self.rows.Cd[row]);
        }
        reaction::accelerations::<D>(&system.inverse_mass, &self.Q, &self.Q_hat, &mut self.qdd);
    }

    /// Power of the drives, of Q̂ as it was solved last [W].
    pub(crate) fn drive_power(&self, system: &System, feedback: &Feedback) -> f64 {
        (1.0 - feedback.elasticity) * measure::drive_power(system, &self.rows.Ct, &self.lambda)
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

    /// C, Ċ, J and γ.
    pub(crate) fn constrain<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        self.rows.evaluate(system.constraints.iter().map(|named| &named.constraint), motion);
    }

    /// A = J W Jᵀ and the factor of A + ε I.
    pub(crate) fn factor<const D: usize>(&mut self, system: &System, epsilon: f64) {
        system.matrix.assemble::<D>(&self.rows.J, &system.inverse_mass, &mut self.A);
        self.solver.factor(&system.matrix, &self.A, epsilon);
    }

    /// What a user should know of the last factorization.
    pub(crate) fn warnings(&self, system: &System) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let rows = self.solver.left_out(&system.matrix).into_iter().filter(|&row| !system.matrix.inert[row]);
        let rows: Vec<String> = rows.map(|row| system.row_names[row].clone()).collect();
        if !rows.is_empty() {
            warnings.push(Warning::NoGradient { rows });
        }
        if self.solver.singular {
            warnings.push(Warning::Singular);
        }
        warnings
    }
}
