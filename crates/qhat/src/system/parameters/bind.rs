//! Bind: new values of the parameters, written to the parts of a system that is built.
//!
//! 1. The range of every value is checked.
//! 2. Every use is evaluated and written; the number before is kept.
//! 3. The parts that were written check their numbers. If one refuses, all numbers before are put back.
//! 4. What follows from numbers is renewed: W, the extent, the scales and the softness of rows, the forces of
//!    constraints that give way, the numbers of contacts, the plan of chains.

use super::quantity::{of_constraint, of_feedback, of_force};
use super::{BindError, Parameter, ParameterUse, Parameters, Quantity, Refused};
use crate::constraint::{Holds, Softness};
use crate::modes::Modes;
use crate::point::block;
use crate::space::{ParticleId, in_dimension};
use crate::state::State;
use crate::system::particle::check_numbers;
use crate::system::{System, check_force, extent};

impl System {
    /// The parameters, in the order of addition.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters.list
    }

    /// The numbers that depend on parameters.
    pub fn parameter_uses(&self) -> &[ParameterUse] {
        &self.parameters.uses
    }

    /// Gives the parameters new values, one for each, in the order of [`System::parameters`]. Every number that depends
    /// on them follows, those of the start included ([`System::start`]). The bits are those of a system built with
    /// these values.
    ///
    /// ```
    /// use qhat::{Dimension, Distance, Parameter, Particle, Quantity, System};
    /// let mut builder = System::builder(Dimension::Two);
    /// let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    /// let bob = builder.particle(Particle::at("bob", [0.0, -1.0]));
    /// let rod = builder.constraint("rod", Distance::new(pivot, bob, 1.0));
    /// builder.parameter(Parameter::new("L", 1.0).within(0.1, 10.0))?;
    /// builder.depends(Quantity::Constraint(rod, "length".into(), 0), "L")?;
    /// builder.depends(Quantity::Position(bob, 1), "-L")?;
    /// let (mut system, _) = builder.build()?;
    ///
    /// system.bind(&[2.5])?;
    /// assert_eq!(system.start().positions(), [0.0, 0.0, 0.0, -2.5]);
    /// assert_eq!(system.bind(&[0.0]).unwrap_err().to_string(),
    ///     "the parameter `L` must be at least 0.1 and at most 10, but is 0");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Another number of values than of parameters; a value out of range; a number that its part refuses, or on which
    /// the structure depends. Nothing is changed then.
    pub fn bind(&mut self, values: &[f64]) -> Result<(), BindError> {
        let mut parameters = std::mem::take(&mut self.parameters);
        let outcome = self.bind_all(&mut parameters, values);
        self.parameters = parameters;
        outcome
    }

    /// The state at the start: the positions and velocities that the builder was given, or those that follow from the
    /// parameters.
    pub fn start(&self) -> State {
        let state = State::new(self.start_q.clone(), self.start_qd.clone());
        State { modes: Modes::at_first(&self.contacts), ..state }
    }

    fn bind_all(&mut self, parameters: &mut Parameters, values: &[f64]) -> Result<(), BindError> {
        let Parameters { list, uses, before } = parameters;
        if values.len() != list.len() {
            return Err(BindError::Count { wanted: list.len(), given: values.len() });
        }
        list.iter().zip(values).try_for_each(|(parameter, &value)| parameter.check(value))?;
        before.clear();
        let outcome = uses.iter().try_for_each(|it| {
            before.push(self.write(it, it.value(values))?);
            Ok(())
        });
        let outcome = outcome.and_then(|()| {
            uses.iter().try_for_each(|it| self.check_use(it).map_err(|reason| it.refused(values, reason)))?;
            let other = uses.iter().find(|it| !self.has_its_structure(it));
            other.map_or(Ok(()), |it| Err(BindError::Structure { place: it.place.clone() }))
        });
        if let Err(error) = outcome {
            let first = uses.iter().find(|it| !self.takes(it));
            let mut culprit = None;
            for (it, &number) in uses.iter().zip(before.iter()).rev() {
                self.write(it, number)?;
                // The number without which the part takes its others is the one to name.
                if culprit.is_none() && first.is_some_and(|first| self.takes(first)) {
                    culprit = Some(it);
                }
            }
            before.clear();
            return Err(match culprit {
                Some(it) => it.named_in(error, values),
                None => error,
            });
        }
        before.clear();
        // Rows of joints that rods hold only to second order were measured with the numbers before.
        self.set_second_order(Vec::new(), &[]);
        list.iter_mut().zip(values).for_each(|(parameter, &value)| parameter.value = value);
        self.renew(uses);
        Ok(())
    }

    /// Writes the number of a use, and returns the number before.
    fn write(&mut self, it: &ParameterUse, value: f64) -> Result<f64, BindError> {
        let number = match &it.quantity {
            None => {
                let built = it.built;
                return if built.to_bits() == value.to_bits() {
                    Ok(built)
                } else {
                    Err(BindError::Structure { place: it.place.clone() })
                };
            }
            Some(quantity) => self.number(quantity),
        };
        let number = number.ok_or_else(|| BindError::NoQuantity { place: it.place.clone() })?;
        Ok(std::mem::replace(number, value))
    }

    /// The number of a quantity.
    fn number(&mut self, quantity: &Quantity) -> Option<&mut f64> {
        let d = self.dimension();
        let coordinate = |particle: &ParticleId, k: usize| (k < d).then_some(particle.0 * d + k);
        match quantity {
            Quantity::Mass(particle) => self.mass.get_mut(particle.0),
            Quantity::Position(particle, k) => self.start_q.get_mut(coordinate(particle, *k)?),
            Quantity::Velocity(particle, k) => self.start_qd.get_mut(coordinate(particle, *k)?),
            Quantity::Constraint(id, key, k) => of_constraint(&mut self.constraints.get_mut(id.0)?.constraint, key, *k),
            Quantity::Force(id, key, k) => of_force(self.forces.get_mut(id.0)?, key, *k),
            Quantity::Feedback(key) => of_feedback(&mut self.feedback, key),
        }
    }

    /// `Ok` if the part of a use takes its number.
    fn check_use(&self, it: &ParameterUse) -> Result<(), Refused> {
        let Some(quantity) = &it.quantity else { return Ok(()) };
        match quantity {
            Quantity::Mass(id) | Quantity::Position(id, _) | Quantity::Velocity(id, _) => {
                in_dimension!(self.dimension, D => {
                    let (x, v) = (block::<D>(&self.start_q, *id), block::<D>(&self.start_qd, *id));
                    check_numbers(&x, &v, self.mass[id.0], self.is_fixed(*id))
                })
                .map_err(Refused::from)
            }
            Quantity::Constraint(id, ..) => {
                let named = &self.constraints[id.0];
                let fits = named.constraint.fits(self.dimension());
                fits.and_then(|()| named.constraint.check()).map_err(Refused::from)
            }
            Quantity::Force(id, ..) => {
                let force = &self.forces[id.0];
                check_force(force, self.dimension, self.particle_count()).map_err(Refused::from)
            }
            Quantity::Feedback(_) => self.feedback.check().map_err(Refused::from),
        }
    }

    /// Whether the part of a use takes its numbers and keeps its structure with them.
    fn takes(&self, it: &ParameterUse) -> bool {
        self.check_use(it).is_ok() && self.has_its_structure(it)
    }

    /// Whether the part of a use has the rows that it was built with: as many, and rigid ones or soft ones.
    fn has_its_structure(&self, it: &ParameterUse) -> bool {
        let Some(Quantity::Constraint(id, ..)) = &it.quantity else { return true };
        let named = &self.constraints[id.0];
        let was_rigid = self.softness.get(named.first_row).is_none_or(Softness::is_rigid);
        named.constraint.softness().is_rigid() == was_rigid
            && named.rows(self.dimension()).end == self.end_of_rows(id.0)
    }

    /// The end of the rows that a constraint has had since the system was built.
    fn end_of_rows(&self, place: usize) -> usize {
        self.constraints.get(place + 1).map_or(self.row_count(), |next| next.first_row)
    }

    /// Renews what follows from the numbers of the uses.
    fn renew(&mut self, uses: &[ParameterUse]) {
        for (w, m) in self.inverse_mass.iter_mut().zip(&self.mass) {
            if *w > 0.0 {
                *w = 1.0 / m;
            }
        }
        let constraints = self.constraints.iter().map(|named| &named.constraint);
        let extent = in_dimension!(self.dimension, D => extent::<D>(constraints, &self.start_q));
        let is_other_extent = extent.to_bits() != self.extent.to_bits();
        self.extent = extent;
        if is_other_extent {
            (0..self.constraints.len()).for_each(|place| self.renew_rows(place));
        } else {
            for it in uses {
                if let Some(Quantity::Constraint(id, ..)) = &it.quantity {
                    self.renew_rows(id.0);
                }
            }
        }
        let soft = self.constraints.iter().filter_map(|named| named.constraint.as_force());
        self.compliant.iter_mut().zip(soft).for_each(|(compliant, force)| compliant.force = force);
        self.contacts.renew(&self.constraints, self.dimension.number());
        if let Some(chains) = &mut self.chains {
            chains.renew(&self.constraints, &self.inverse_mass);
        }
    }

    /// The scale and the softness of the rows of a constraint.
    fn renew_rows(&mut self, place: usize) {
        let named = &self.constraints[place];
        let rows = named.rows(self.dimension());
        self.row_scale[rows.clone()].fill(named.constraint.scale(self.extent));
        self.softness[rows].fill(named.constraint.softness());
    }
}
