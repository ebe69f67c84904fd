//! The equation: from a motion to λ, Q̂ and q̈.
//!
//! ```text
//! (J W Jᵀ + ε I) λ = −γ − J W Q − ks C − kd Ċ,   Q̂ = s Jᵀ λ,   q̈ = W (Q + Q̂)
//! ```
//!
//! The friction F of sliding contacts follows λ and is added to both: −J W F to the right-hand side, W F to q̈
//! (`friction.rs`). Readers see F as multipliers of tangential rows and as a part of Q̂. A soft row is inert: its force
//! is part of Q, and λ only reports it.

use super::{Equation, reaction};
use crate::point::Motion;
use crate::settings::Feedback;
use crate::state::Rank;
use crate::system::System;
use std::sync::Arc;

/// Growth from the right-hand side to λ, rows scaled, above which λ is refined by the q̈ that it gives: a crossed
/// cantilever of ten bays, with a growth of a hundred, loses two of sixteen digits of its forces.
const BALANCED: f64 = 10.0;

/// The same in a stage of a step, which needs q̈ alone. A growth of 1e4 costs λ four digits, and Jᵀλ two of them: what
/// is left is below the least error that a tolerance can ask for, and the projection takes it up.
const BALANCED_IN_A_STAGE: f64 = 1e4;

/// Change of λ, relative, at which its refinement ends: the next would be smaller by as much again.
const SETTLED: f64 = 1e-11;

/// Passes of that refinement. A cantilever of 1000 bays takes two.
const PASSES: usize = 3;

/// Smallest pivot with which all rows are independent without a question.
const INDEPENDENT: f64 = 1e-2;

/// Part of the smallest pivot where the rank was found below which the question is asked again: the rank may drop here.
const DOUBTFUL: f64 = 1e-4;

/// Margin to a singular position below which the motion approaches it: C is then held to roundoff, and substeps are
/// placed. Open chains, which hold C to its tolerance, go over to the general path there.
pub(crate) const APPROACH: f64 = 0.2;

/// Growth of the smallest pivot at which the rank is noted anew: a motion may begin near a position where it drops.
const GROWN: f64 = 4.0;

/// The largest sine of a rank that is noted; 1 stands for one that is not known.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON;

/// What a solution of the equation is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Needed {
    /// q̈, in a stage of a step.
    Accelerations,
    /// λ and Q̂, too, to be read or to decide about contacts.
    Forces,
}

impl Equation {
    /// Solves the equation at one motion, everything from Q to q̈. `is_factored`: the factor of A + ε I at this q and
    /// t is at hand, and no new one is made.
    pub(crate) fn solve<const D: usize>(
        &mut self,
        system: &System,
        motion: Motion<'_, D>,
        feedback: &Feedback,
        is_factored: bool,
        needed: Needed,
    ) {
        let (W, s) = (&system.inverse_mass, 1.0 - feedback.elasticity);
        self.apply_forces(system, motion); // Q, W Q
        self.constrain(system, motion); // C, Ċ, J, γ
        self.b.assemble::<D>(&self.rows, &self.WQ, feedback); // b = −γ − J W Q − ks C − kd Ċ
        if !is_factored {
            self.factor::<D>(system, feedback.diagonal_drag); // A + ε I
        }
        self.solve_multipliers::<D>(system); // (A + ε I) λ = b, and F
        self.imbalance = self.imbalance.max(self.solver.imbalance());
        reaction::constraint_forces::<D>(&self.rows.J, &self.lambda, s, &mut self.Q_hat); // Q̂ = s Jᵀ λ
        reaction::accelerations::<D>(W, &self.Q, &self.Q_hat, &mut self.qdd); // q̈ = W (Q + Q̂)
        if !self.sliding.is_empty() {
            reaction::add_accelerations::<D>(W, &self.friction.force, &mut self.qdd); // q̈ += W F
        } else if self.solver.growth() > if needed == Needed::Forces { BALANCED } else { BALANCED_IN_A_STAGE } {
            self.balance::<D>(system, s);
        }
        self.report_soft_rows(system); // λ of soft rows, whose forces are in Q already
    }

    /// Refines λ by the q̈ that it gives.
    ///
    /// ```text
    /// A δλ = −γ − ks C − kd Ċ − J q̈,   λ += δλ
    /// ```
    ///
    /// A rounding e of the forces Q + Q̂ changes the right-hand side by J W e, and Jᵀ δλ by the part of e that the
    /// constraints take up, which is no larger than e. A rounding of the right-hand side itself would be divided by the
    /// sine of the least independent combination of rows, which is 1e-5 in a cantilever of 200 bays.
    fn balance<const D: usize>(&mut self, system: &System, s: f64) {
        let W = &system.inverse_mass;
        let size = self.solver.largest_x();
        for _ in 0..PASSES {
            self.rows.J.multiply::<D>(&self.qdd, &mut self.balance.residual);
            for (row, residual) in self.balance.residual.iter_mut().enumerate() {
                *residual = self.b.bias[row] + self.b.stiffness[row] + self.b.damping[row] - *residual;
            }
            self.solver.solve(&system.matrix, &self.balance.residual, &mut self.balance.change);
            for (lambda, change) in self.lambda.iter_mut().zip(&self.balance.change) {
                *lambda += change;
            }
            reaction::constraint_forces::<D>(&self.rows.J, &self.lambda, s, &mut self.Q_hat);
            reaction::accelerations::<D>(W, &self.Q, &self.Q_hat, &mut self.qdd);
            // A change that is not a number ends the passes, too.
            let is_changed = self.solver.largest_x() > SETTLED * size;
            if !is_changed {
                break;
            }
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
        system.add_forces(motion, &self.broken, &mut self.Q);
        for (i, &w) in system.inverse_mass.iter().enumerate() {
            for k in i * D..(i + 1) * D {
                self.WQ[k] = w * self.Q[k];
            }
        }
    }

    /// A = J W Jᵀ and the factor of A + ε I, over active rows that are independent of each other. Whether rows follow
    /// from others is asked where the equation is first solved, and at positions where a pivot is much smaller than
    /// there.
    pub(crate) fn factor<const D: usize>(&mut self, system: &System, epsilon: f64) {
        let (matrix, W) = (&system.matrix, &system.inverse_mass);
        matrix.assemble::<D>(&self.rows.J, W, &mut self.A);
        if epsilon > 0.0 {
            // A + ε I is positive definite; only roundoff can spoil it.
            let smallest = self.solver.factor(matrix, &self.A, epsilon, &self.inactive, system.following());
            if smallest.is_nan() || smallest <= 0.0 {
                self.solver.factor_perturbed(matrix, &self.A, epsilon, &self.inactive, system.following());
            }
            return;
        }
        let rank = self.rank.take().filter(|rank| rank.inactive == self.inactive);
        let known: &[u32] = rank.as_ref().map_or(system.following(), |rank| &rank.dependent);
        let smallest = self.solver.factor(matrix, &self.A, 0.0, &self.inactive, known);
        let expected = rank.as_ref().map_or(INDEPENDENT, |rank| DOUBTFUL * rank.least);
        // A pivot that is not a number is not above either.
        let is_sure = smallest > expected;
        if !is_sure {
            let dependent = self.dependent_rows::<D>(system);
            matrix.assemble::<D>(&self.rows.J, W, &mut self.A);
            self.solver.factor_perturbed(matrix, &self.A, 0.0, &self.inactive, &dependent);
        }
        self.rank = rank.or_else(|| {
            let (inactive, dependent) = (self.inactive.clone(), self.solver.dependent().to_vec());
            let (rows, least) = (system.all_row_count(), self.solver.smallest_pivot().min(1.0));
            Some(Arc::new(Rank { rows, inactive, dependent, least, sine: 1.0 }))
        });
    }

    /// The factor of A + δ I in scaled rows, every active row among them: Jᵀλ then comes nearest to the right-hand side
    /// where rows contradict each other.
    pub(crate) fn factor_least_squares<const D: usize>(&mut self, system: &System) {
        system.matrix.assemble::<D>(&self.rows.J, &system.inverse_mass, &mut self.A);
        self.solver.factor_shifted(&system.matrix, &self.A, &self.inactive, system.following());
    }

    /// The rows that follow from others, for the next frame, with the smallest pivot and sine of any position so far.
    pub(crate) fn rank_to_keep<const D: usize>(&mut self, system: &System) -> Option<Arc<Rank>> {
        let rank = self.rank.clone()?;
        let smallest = self.solver.smallest_pivot().min(1.0);
        let is_known = rank.sine < 1.0 && smallest <= GROWN * rank.least;
        if is_known || self.solver.dependent() != rank.dependent {
            return Some(rank);
        }
        let sine = self.least_sine::<D>(system).min(BELOW_ONE);
        Some(Arc::new(Rank { least: smallest.max(rank.least), sine, ..Rank::clone(&rank) }))
    }

    /// The sine of the least independent row over that of the position where the rank was noted: how far a singular
    /// position is. `None` where the rank has dropped. Pivots of A answer where they are large; where they are small,
    /// masses may be the reason, and the pivots of J Jᵀ answer.
    pub(crate) fn margin<const D: usize>(&mut self, system: &System) -> Option<f64> {
        let rank = self.rank.clone()?;
        if self.solver.dependent() != rank.dependent {
            return None;
        }
        let margin = (self.solver.smallest_pivot() / rank.least).sqrt();
        if margin >= APPROACH || rank.sine == 1.0 {
            return Some(margin);
        }
        Some(self.least_sine::<D>(system) / rank.sine)
    }

    /// The least sine between a row that is kept and the rows before it.
    fn least_sine<const D: usize>(&mut self, system: &System) -> f64 {
        self.assemble_without_masses::<D>(system);
        let dependent = self.solver.dependent().to_vec();
        let smallest = self.solver.factor(&system.matrix, &self.A, 0.0, &self.inactive, &dependent);
        self.factor::<D>(system, 0.0);
        // Where the rank drops, roundoff may leave a pivot that is not positive.
        smallest.max(0.0).sqrt()
    }

    /// Whether a row follows from others at the position where the rank was noted. `is_left_out` asks for the factor at
    /// hand.
    pub(crate) fn follows(&self, row: usize) -> bool {
        self.rank.as_ref().is_some_and(|rank| rank.dependent.binary_search(&(row as u32)).is_ok())
    }

    /// λ for the right-hand side at hand, and F of the sliding contacts; λ is not a number where friction has no
    /// answer.
    pub(crate) fn solve_multipliers<const D: usize>(&mut self, system: &System) {
        let Equation { sliding, friction, rows, b, lambda, solver, .. } = self;
        solver.solve(&system.matrix, &b.sum, lambda);
        if !sliding.is_empty() {
            friction.solve::<D>(sliding, rows, &system.inverse_mass, lambda, |target, answer| {
                solver.solve(&system.matrix, target, answer);
            });
        }
    }

    /// λ = −(C/α + c Ċ) of soft rows.
    fn report_soft_rows(&mut self, system: &System) {
        for (row, soft) in system.softness.iter().enumerate().filter(|(_, soft)| !soft.is_rigid()) {
            let lambda = -(self.rows.C[row] / soft.compliance + soft.damping * self.rows.Cd[row]);
            self.lambda[row] = if self.is_inactive(row) { 0.0 } else { lambda };
        }
    }
}
