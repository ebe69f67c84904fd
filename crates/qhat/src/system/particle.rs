//! A point mass and its number.

/// The number of a particle: its place in the order they were added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ParticleId(pub usize);

/// A point mass, as it is handed to the builder.
#[derive(Clone, Debug, PartialEq)]
pub struct Particle {
    /// Its name, unique in the system.
    pub name: String,
    /// x [m], d numbers.
    pub position: Vec<f64>,
    /// v [m/s], d numbers.
    pub velocity: Vec<f64>,
    /// m [kg], positive.
    pub mass: f64,
    /// Whether it is held where it is (W = 0).
    pub fixed: bool,
}

impl Particle {
    /// A particle of 1 kg at rest at x [m].
    pub fn at(name: impl Into<String>, position: impl Into<Vec<f64>>) -> Self {
        let position = position.into();
        Particle { name: name.into(), velocity: vec![0.0; position.len()], position, mass: 1.0, fixed: false }
    }

    /// The same with another mass [kg].
    pub fn with_mass(self, mass: f64) -> Self {
        Particle { mass, ..self }
    }

    /// The same with a velocity [m/s].
    pub fn with_velocity(self, velocity: impl Into<Vec<f64>>) -> Self {
        Particle { velocity: velocity.into(), ..self }
    }

    /// The same, held where it is.
    pub fn held(self) -> Self {
        Particle { fixed: true, ..self }
    }
}
