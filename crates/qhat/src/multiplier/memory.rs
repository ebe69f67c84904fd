//! FactorMemory: the state whose A is factored.
//!
//! Invariant: if `at` is not empty, the solver holds the factor of A = J W Jᵀ, without ε, at that q and t, for the rows
//! that were active then. So
//!
//! - every factorization forgets (`MultiplierSolver::factor`), and a caller that knows its state notes it;
//! - a method forgets before it moves the state;
//! - `is_of` asks for the inactive rows, too: other modes of contacts are another A.
//!
//! A factor that is kept must not change a bit of the motion: readers of terms between two steps, and restarts from a
//! saved state, get the same motion.

use crate::state::State;

/// The state and the active rows of the factor at hand.
#[derive(Clone, Debug, Default)]
pub(crate) struct FactorMemory {
    /// q with t behind it; empty if it is not known.
    at: Vec<f64>,
    /// The inactive rows of that factor; empty in a system without contacts.
    inactive: Vec<bool>,
}

impl FactorMemory {
    /// Whether the factor at hand is that of A at the state, with these rows inactive.
    pub(crate) fn is_of(&self, state: &State, inactive: &[bool]) -> bool {
        self.at.split_last() == Some((&state.t, &state.q[..])) && self.inactive == inactive
    }

    /// Notes that the factor at hand is that of A at the state, with these rows inactive.
    pub(crate) fn note(&mut self, state: &State, inactive: &[bool]) {
        self.at.clone_from(&state.q);
        self.at.push(state.t);
        self.inactive.clear();
        self.inactive.extend_from_slice(inactive);
    }

    /// The factor at hand belongs to no known state.
    pub(crate) fn forget(&mut self) {
        self.at.clear();
    }
}
