//! Parameters: named numbers of a system, and the numbers of its parts that depend on them.
//!
//! A *use* is a number of a part, such as the length of a rod, that is given by an expression of parameters.
//! [`System::bind`](crate::System::bind) takes new values of all parameters, evaluates every use, checks the parts and
//! renews what follows from their numbers. It allocates nothing and plans nothing anew, and leaves the same bits as
//! [`SystemBuilder::build`](crate::SystemBuilder::build) with these values: `build` itself ends with it.
//!
//! `quantity.rs` has the numbers that may be given, `declare.rs` the uses as the builder takes them, `bind.rs` the new
//! values, `error.rs` the refusals.

mod bind;
mod declare;
mod error;
mod quantity;

pub use error::{BindError, Refused};
pub use quantity::Quantity;

use crate::expression::Expression;
use std::fmt;

/// A named number of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name in expressions.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The least and the greatest value that are allowed; infinite where there is no limit.
    pub range: [f64; 2],
    /// Its unit, a text for people; may be empty.
    pub unit: String,
}

impl Parameter {
    /// A parameter without limits.
    pub fn new(name: impl Into<String>, value: f64) -> Self {
        Parameter { name: name.into(), value, range: [f64::NEG_INFINITY, f64::INFINITY], unit: String::new() }
    }

    /// The same with a least and a greatest value.
    pub fn within(self, least: f64, greatest: f64) -> Self {
        Parameter { range: [least, greatest], ..self }
    }

    /// `Ok` if it may have a value.
    ///
    /// # Errors
    /// A value that is not finite or out of range.
    pub fn check(&self, value: f64) -> Result<(), BindError> {
        if !value.is_finite() {
            return Err(BindError::NotFinite { name: self.name.clone(), value });
        }
        let [least, greatest] = self.range;
        if (least..=greatest).contains(&value) {
            return Ok(());
        }
        Err(BindError::OutOfRange { name: self.name.clone(), value, least, greatest })
    }
}

/// A number of a part that depends on parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterUse {
    /// The place, a text for people, such as `constraints[2].length`.
    pub place: String,
    pub(super) expression: Expression,
    /// `None` for a number on which the structure depends.
    pub(super) quantity: Option<Quantity>,
    /// The value with which the system was built, of a number on which the structure depends; else 0.
    pub(super) built: f64,
}

impl ParameterUse {
    /// The text of the expression.
    pub fn text(&self) -> &str {
        self.expression.text()
    }

    /// Whether [`System::bind`](crate::System::bind) can change the number. Otherwise the system must be built anew.
    pub fn is_bindable(&self) -> bool {
        self.quantity.is_some()
    }

    /// Whether the number depends on the parameter at a place in [`System::parameters`](crate::System::parameters).
    pub fn depends_on(&self, parameter: usize) -> bool {
        self.expression.reads(parameter)
    }

    fn value(&self, values: &[f64]) -> f64 {
        self.expression.value(values, &[], 0.0)
    }

    fn refused(&self, values: &[f64], reason: Refused) -> BindError {
        BindError::Refused { place: self.place.clone(), value: self.value(values), reason }
    }

    /// The refusal of the part of this use, with its own place and value.
    fn named_in(&self, refusal: BindError, values: &[f64]) -> BindError {
        match refusal {
            BindError::Refused { reason, .. } => self.refused(values, reason),
            BindError::Structure { .. } => BindError::Structure { place: self.place.clone() },
            other => other,
        }
    }
}

impl fmt::Display for ParameterUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.place, self.text())
    }
}

/// The parameters of a system, their uses, and room to bind them.
#[derive(Clone, Debug, Default)]
pub(super) struct Parameters {
    pub(super) list: Vec<Parameter>,
    pub(super) uses: Vec<ParameterUse>,
    /// The value of each use before the bind in progress.
    pub(super) before: Vec<f64>,
}
