//! A constraint with the name that a user gave it.

use super::Constraint;

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
