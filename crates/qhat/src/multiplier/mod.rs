//! The equation for every system, and the quantities of one evaluation.
//!
//! `equation.rs` solves it; its parts are `rhs.rs` (b), `matrix.rs` (A), `factor.rs` and `independent.rs` (λ),
//! `reaction.rs` (Q̂ and q̈) and `friction.rs` (F). `active.rs` keeps the rows of inactive constraints out of it,
//! `pushes.rs` is the change of velocity by λ, and its power; `memory.rs` remembers which A is factored;
//! `second_order.rs` finds rods that hold only to second order.
//!
//! Where rows are redundant, λ is not unique. Modes of contacts are decided by the λ of `sticking.rs` and `cones.rs`;
//! people read that of `share/`.

mod active;
mod cones;
mod equation;
mod factor;
mod friction;
mod independent;
mod matrix;
mod memory;
mod pushes;
mod reaction;
mod rhs;
mod second_order;
mod share;
mod sticking;
#[cfg(test)]
mod tests;

pub(crate) use equation::{APPROACH, Needed};
pub(crate) use factor::MultiplierSolver;
pub(crate) use friction::{Friction, Sliding};
pub(crate) use independent::SAME;
pub(crate) use rhs::RightHandSide;
pub use second_order::Freedom;
pub(crate) use second_order::{freedom, second_order};
pub(crate) use share::{RowsToShare, Share, Sticking};

use crate::constraint::Rows;
use crate::report::Warning;
use crate::state::Rank;
use crate::system::System;
use std::sync::Arc;

/// Every quantity of one evaluation, in arrays that are made once and written again.
///
/// Letters: n particles in d dimensions, m rows; W, Q, C, J, γ, A, b, λ, Q̂, q̈ as in the notation table.
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
    /// For each row whether it is inactive; empty in a system without contacts.
    pub(crate) inactive: Vec<bool>,
    /// For each breakable constraint whether it is broken; empty until modes are set.
    pub(crate) broken: Vec<bool>,
    /// C and Ċ of every row, where those of inactive rows are zero in `rows`; empty in a system without contacts.
    pub(crate) gaps: Gaps,
    /// The sliding contacts, with their slips in the substep being tried.
    pub(crate) sliding: Vec<Sliding>,
    pub(crate) friction: Friction,
    /// The largest residual of A λ = b, relative to b, since it was last taken (`integrate/adaptive/acceptance.rs`).
    pub(crate) imbalance: f64,
    /// The refinement of λ by q̈.
    balance: Balance,
    /// The rows that follow from others, with the rows that were active when they were found.
    pub(crate) rank: Option<Arc<Rank>>,
    /// W Jᵀλ, or W (Jᵀλ + F), as written last (`pushes.rs`): d·n numbers; empty until then.
    pub(crate) W_JT_lambda: Vec<f64>,
}

/// C and Ċ of every row, m numbers each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gaps {
    pub(crate) C: Vec<f64>,
    pub(crate) Cd: Vec<f64>,
}

/// The residual of C̈ in every row, and the change of λ that removes it; m numbers each.
#[derive(Clone, Debug)]
struct Balance {
    residual: Vec<f64>,
    change: Vec<f64>,
}

impl Equation {
    pub(crate) fn new(system: &System) -> Self {
        let (coordinates, m) = (system.coordinate_count(), system.all_row_count());
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
            broken: Vec::new(),
            gaps: Gaps::default(),
            sliding: Vec::new(),
            friction: Friction::default(),
            balance: Balance { residual: vec![0.0; m], change: vec![0.0; m] },
            imbalance: 0.0,
            rank: None,
            W_JT_lambda: Vec::new(),
        }
    }

    /// Warnings of the last factorization: rows without a gradient, a singular A.
    pub(crate) fn warnings(&self, system: &System) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let rows = self
            .solver
            .left_out(&system.matrix)
            .into_iter()
            .filter(|&row| !system.matrix.inert[row] && !self.is_inactive(row))
            .filter(|&row| !self.is_left_out(row));
        let rows: Vec<String> = rows.map(|row| system.row_names[row].clone()).collect();
        if !rows.is_empty() {
            warnings.push(Warning::NoGradient { rows });
        }
        if !system.second_order.is_empty() {
            warnings.push(Warning::SecondOrder { joints: system.names_of_cliques() });
        }
        if self.solver.dependent().len() > system.following().len() {
            warnings.push(Warning::Singular);
        }
        warnings
    }
}
