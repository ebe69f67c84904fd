//! Parameters and their uses, as the builder is given them.

use super::quantity::{of_constraint, of_feedback, of_force};
use super::{BindError, Parameter, ParameterUse, Quantity};
use crate::expression::{Expression, ParameterError, check_parameter};
use crate::space::ParticleId;
use crate::system::SystemBuilder;

impl SystemBuilder {
    /// Adds a parameter; its place counts from 0.
    ///
    /// # Errors
    /// A name that is no word, that has a meaning in expressions or that another parameter has; a value out of range.
    pub fn parameter(&mut self, parameter: Parameter) -> Result<usize, BindError> {
        check_parameter(&parameter.name, parameter.value)?;
        if self.parameters.list.iter().any(|other| other.name == parameter.name) {
            return Err(ParameterError::NameTaken { name: parameter.name }.into());
        }
        parameter.check(parameter.value)?;
        self.parameters.list.push(parameter);
        Ok(self.parameters.list.len() - 1)
    }

    /// Makes a number depend on the parameters that were added so far. The number takes the value of the text at once,
    /// and again with every [`System::bind`](crate::System::bind).
    ///
    /// # Errors
    /// A quantity that the part does not have, or that follows a function of time; a text that is no expression of
    /// parameters.
    pub fn depends(&mut self, quantity: Quantity, text: &str) -> Result<&mut Self, BindError> {
        let names: Vec<&str> = self.parameters.list.iter().map(|parameter| parameter.name.as_str()).collect();
        let expression = Expression::of_parameters(text, &names, &|_, _| None);
        let expression = expression.map_err(|reason| BindError::Text { text: text.into(), reason })?;
        let place = self.place_of(&quantity);
        self.depends_at(place, Some(quantity), expression)
    }

    /// The same with an expression from [`Expression::of_parameters`], which knows the parameters in the same order,
    /// and with a place that errors name. Without a quantity, the structure depends on the number: a bind that would
    /// change the number is refused.
    ///
    /// # Errors
    /// A quantity that the part does not have, or that follows a function of time.
    pub fn depends_at(
        &mut self,
        place: String,
        quantity: Option<Quantity>,
        expression: Expression,
    ) -> Result<&mut Self, BindError> {
        let values: Vec<f64> = self.parameters.list.iter().map(|parameter| parameter.value).collect();
        let built = expression.value(&values, &[], 0.0);
        if let Some(quantity) = &quantity {
            let Some(number) = self.number(quantity) else { return Err(BindError::NoQuantity { place }) };
            *number = built;
        }
        let built = if quantity.is_some() { 0.0 } else { built };
        self.parameters.uses.push(ParameterUse { place, expression, quantity, built });
        Ok(self)
    }

    /// A number of a part that was added; `None` if the part does not have it, or if it follows a function of time.
    pub fn number(&mut self, quantity: &Quantity) -> Option<&mut f64> {
        match quantity {
            Quantity::Mass(id) => self.particles.get_mut(id.0).map(|particle| &mut particle.mass),
            Quantity::Position(id, k) => self.particles.get_mut(id.0)?.position.get_mut(*k),
            Quantity::Velocity(id, k) => self.particles.get_mut(id.0)?.velocity.get_mut(*k),
            Quantity::Constraint(id, key, k) => of_constraint(&mut self.constraints.get_mut(id.0)?.1, key, *k),
            Quantity::Force(id, key, k) => of_force(&mut self.forces.get_mut(id.0)?.1, key, *k),
            Quantity::Feedback(key) => of_feedback(&mut self.feedback, key),
        }
    }

    /// The place of a quantity, in words.
    fn place_of(&self, quantity: &Quantity) -> String {
        let particle = |id: ParticleId| self.particles.get(id.0).map_or("", |particle| &particle.name);
        let entry = |key: &str, k: usize| if k == 0 { key.to_owned() } else { format!("{key}[{k}]") };
        match quantity {
            Quantity::Mass(id) => format!("mass of {}", particle(*id)),
            Quantity::Position(id, k) => format!("position[{k}] of {}", particle(*id)),
            Quantity::Velocity(id, k) => format!("velocity[{k}] of {}", particle(*id)),
            Quantity::Constraint(id, key, k) => {
                format!("{} of {}", entry(key, *k), self.constraints.get(id.0).map_or("", |(name, _)| name))
            }
            Quantity::Force(id, key, k) => {
                let named = self.forces.get(id.0).and_then(|(name, _)| name.clone());
                format!("{} of {}", entry(key, *k), named.unwrap_or_else(|| format!("force {}", id.0)))
            }
            Quantity::Feedback(key) => format!("{key} of the feedback"),
        }
    }
}
