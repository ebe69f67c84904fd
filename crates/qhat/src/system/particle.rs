//! A point mass.

use super::ParticleError;

/// A point mass, as it is handed to the builder.
#[derive(Clone, Debug, PartialEq)]
pub struct Particle {
    /// Its name, unique in the system.
    pub name: String,
    /// x \[m\], d numbers.
    pub position: Vec<f64>,
    /// v [m/s], d numbers.
    pub velocity: Vec<f64>,
    /// m \[kg\], positive.
    pub mass: f64,
    /// Whether the particle stays where it is (W = 0).
    pub fixed: bool,
}

impl Particle {
    /// A particle of 1 kg at rest at x \[m\].
    pub fn at(name: impl Into<String>, position: impl Into<Vec<f64>>) -> Self {
        let position = position.into();
        Particle { name: name.into(), velocity: vec![0.0; position.len()], position, mass: 1.0, fixed: false }
    }

    /// The same with another mass \[kg\].
    pub fn with_mass(self, mass: f64) -> Self {
        Particle { mass, ..self }
    }

    /// The same with a velocity [m/s].
    pub fn with_velocity(self, velocity: impl Into<Vec<f64>>) -> Self {
        Particle { velocity: velocity.into(), ..self }
    }

    /// The same, fixed where it is: W = 0.
    pub fn fixed(self) -> Self {
        Particle { fixed: true, ..self }
    }

    /// `Ok` if the particle can be in d dimensions.
    pub(super) fn check(&self, dimension: usize) -> Result<(), ParticleError> {
        for (what, components) in [("position", &self.position), ("velocity", &self.velocity)] {
            if components.len() != dimension {
                return Err(ParticleError::Components { what, dimension, count: components.len() });
            }
        }
        check_numbers(&self.position, &self.velocity, self.mass, self.fixed)
    }

    /// The former name of [`Particle::fixed`].
    #[deprecated(since = "0.1.0", note = "use `fixed`")]
    pub fn held(self) -> Self {
        self.fixed()
    }
}

/// `Ok` if a particle may have these numbers.
pub(super) fn check_numbers(x: &[f64], v: &[f64], mass: f64, is_fixed: bool) -> Result<(), ParticleError> {
    if !x.iter().chain(v).all(|x| x.is_finite()) {
        return Err(ParticleError::NotFinite);
    }
    if !(mass.is_finite() && mass > 0.0 && (1.0 / mass).is_finite()) {
        return Err(ParticleError::Mass { mass });
    }
    if is_fixed && v.iter().any(|&v| v != 0.0) {
        return Err(ParticleError::FixedWithVelocity);
    }
    Ok(())
}
