//! The equation: from a motion to λ, Q̂ and q̈.
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ,   Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```

mod factor;
mod friction;
mod matrix;
mod reaction;
mod rhs;
#[cfg(test)]
mod tests;

pub(crate) use factor::{MultiplierSolver, SolveFor};
pub(crate) use rhs::RightHandSide;

use crate::constraint::Rows;
use crate::energy;
use crate::modes::{Mode, Modes};
use crate::point::Motion;
use crate::report::Warning;
use crate::settings::Feedback;
use crate::system::System;
use friction::Sliding;
pub(crate) use friction::{Beginning, Friction};

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
    /// For each row whether it takes no part; empty where nothing contacts.
    pub(crate) inactive: Vec<bool>,
    /// C and Ċ of every row, where those that take no part are zero in `rows`; empty where nothing contacts.
    pub(crate) gaps: Gaps,
    pub(crate) friction: Friction,
    /// W (Jᵀλ + F), of the last λ that was asked for: d·n numbers; empty until then.
    pub(crate) push: Vec<f64>,
}

/// C and Ċ of every row, m numbers each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gaps {
    pub(crate) C: Vec<f64>,
    pub(crate) Cd: Vec<f64>,
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
            inactive: vec![false; if system.contacts.is_empty() { 0 } else { m }],
            gaps: Gaps::default(),
            friction: Friction::default(),
            push: Vec::new(),
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
        wanted: SolveFor,
    ) {
        self.apply_forces(system, motion);
        self.constrain(system, motion);
        self.b.assemble::<D>(&self.rows, &self.WQ, feedback);
        if !is_factored {
            self.factor::<D>(system, feedback.diagonal_drag);
        }
        self.solve_multipliers::<D>(system, wanted);
        let s = 1.0 - feedback.elasticity;
        reaction::constraint_forces::<D>(&self.rows.J, &self.lambda, s, &mut self.Q_hat);
        // What gives way has acted in Q already; its λ is told all the same.
        for (row, soft) in system.softness.iter().enumerate().filter(|(_, soft)| !soft.is_rigid()) {
            self.lambda[row] = -(self.rows.C[row] / soft.compliance + soft.damping * self.rows.Cd[row]);
        }
        reaction::accelerations::<D>(&system.inverse_mass, &self.Q, &self.Q_hat, &mut self.qdd);
        if !self.friction.is_empty() {
            reaction::add_accelerations::<D>(&system.inverse_mass, &self.friction.force, &mut self.qdd);
        }
    }

    /// λ for the right side at hand, friction of what slides included; where that has no answer λ is not a number.
    pub(crate) fn solve_multipliers<const D: usize>(&mut self, system: &System, wanted: SolveFor) {
        let Equation { friction, rows, b, lambda, solver, .. } = self;
        solver.solve(&system.matrix, &b.sum, wanted, lambda);
        let count = friction.sliding.len();
        if count == 0 {
            return;
        }
        friction.begin(count, lambda.len());
        for s in 0..count {
            friction.write_unit::<D>(s, rows, &system.inverse_mass);
            solver.solve(&system.matrix, &friction.target, wanted, &mut friction.answers[s]);
        }
        friction.finish::<D>(rows, lambda);
    }

    /// W (Jᵀλ + F) for λ at hand.
    pub(crate) fn write_push<const D: usize>(&mut self, system: &System) {
        self.write_impulse::<D>(system);
        if !self.friction.is_empty() {
            reaction::add_accelerations::<D>(&system.inverse_mass, &self.friction.force, &mut self.push);
        }
    }

    /// W Jᵀλ for λ at hand.
    pub(crate) fn write_impulse<const D: usize>(&mut self, system: &System) {
        self.Q_hat.fill(0.0);
        self.rows.J.add_transposed::<D>(&self.lambda, &mut self.Q_hat);
        self.push.clear();
        self.push.resize(system.coordinate_count(), 0.0);
        reaction::add_accelerations::<D>(&system.inverse_mass, &self.Q_hat, &mut self.push);
    }

    /// J W (Jᵀλ + F) in one row, as it was pushed last.
    pub(crate) fn push_along<const D: usize>(&self, row: usize) -> f64 {
        self.rows.J.multiply_row::<D>(row, &self.push)
    }

    /// Which rows take part from now on. Nothing is factored for them yet.
    pub(crate) fn set_modes(&mut self, system: &System, modes: &Modes) {
        modes.write_inactive(&system.contacts, &mut self.inactive);
        self.friction.sliding.clear();
        for (contact, mode) in system.contacts.list.iter().zip(&modes.contacts) {
            if let Mode::Sliding(direction) = *mode {
                let (normal, tangents, friction) = (contact.normal, contact.tangents.clone(), contact.friction);
                self.friction.sliding.push(Sliding {
                    normal,
                    tangents,
                    friction,
                    direction,
                    began: direction,
                    turns: false,
                });
            }
        }
    }

    /// Power of the drives, of Q̂ as it was solved last [W].
    pub(crate) fn drive_power(&self, system: &System, feedback: &Feedback) -> f64 {
        (1.0 - feedback.elasticity) * energy::drive_power(system, &self.rows.Ct, &self.lambda)
    }

    /// Power of the friction of what slides, of λ as it was solved last [W].
    pub(crate) fn friction_power(&self, qd: &[f64]) -> f64 {
        if self.friction.is_empty() {
            return 0.0;
        }
        self.friction.force.iter().zip(qd).map(|(force, velocity)| force * velocity).sum()
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

    /// C, Ċ, J and γ, with zeros where a row takes no part.
    pub(crate) fn constrain<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        self.constrain_all(system, motion);
        if self.inactive.is_empty() {
            return;
        }
        if !self.friction.is_empty() {
            self.friction.follow(&self.rows);
        }
        self.gaps.C.clone_from(&self.rows.C);
        self.gaps.Cd.clone_from(&self.rows.Cd);
        for row in (0..self.inactive.len()).filter(|&row| self.inactive[row]) {
            (self.rows.C[row], self.rows.Cd[row], self.rows.gamma[row]) = (0.0, 0.0, 0.0);
        }
    }

    /// C, Ċ, J and γ of every row, whether it takes part or not.
    pub(crate) fn constrain_all<const D: usize>(&mut self, system: &System, motion: Motion<'_, D>) {
        system.evaluate_rows(motion, &mut self.rows);
    }

    /// A = J W Jᵀ and the factor of A + ε I.
    pub(crate) fn factor<const D: usize>(&mut self, system: &System, epsilon: f64) {
        system.matrix.assemble::<D>(&self.rows.J, &system.inverse_mass, &mut self.A);
        self.solver.factor(&system.matrix, &self.A, epsilon, &self.inactive);
    }

    /// Whether a row takes no part now.
    pub(crate) fn is_inactive(&self, row: usize) -> bool {
        self.inactive.get(row).is_some_and(|inactive| *inactive)
    }

    /// What a user should know of the last factorization.
    pub(crate) fn warnings(&self, system: &System) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let rows = self
            .solver
            .left_out(&system.matrix)
            .into_iter()
            .filter(|&row| !system.matrix.inert[row] && !self.is_inactive(row));
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
