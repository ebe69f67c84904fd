//! A constraint with the name that a user gave it.

use super::{Constraint, Holds};
use std::ops::Range;

/// A constraint with its name and its place among the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedConstraint {
    /// The name, for reports.
    pub name: String,
    /// The constraint.
    pub constraint: Constraint,
    /// The first row of the constraint in C, λ and J.
    pub first_row: usize,
}

impl NamedConstraint {
    /// The rows of the constraint in C, λ and J, in a system of d dimensions.
    pub(crate) fn rows(&self, dimension: usize) -> Range<usize> {
        self.first_row..self.first_row + self.constraint.row_count(dimension)
    }
}
