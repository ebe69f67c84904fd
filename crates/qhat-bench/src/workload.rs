//! A workload in neutral form: the input that all engines share, without anything that belongs to one of them.

use qhat::{BuildError, Dimension, Distance, Gravity, Particle, State, System, SystemBuilder};
use serde::Serialize;

/// The gravity of all workloads, downwards in y \[m/s²\].
pub(crate) const GRAVITY: f64 = 9.81;

/// Particles, rods and gravity, with the length and the number of frames to simulate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Workload {
    /// The name, for example `chain100`.
    pub name: String,
    /// d, 2 or 3.
    pub dimension: usize,
    /// g \[m/s²\], d numbers.
    pub gravity: Vec<f64>,
    /// Length of a frame \[s\]: every engine writes its state at the end of each frame.
    pub frame: f64,
    /// The number of frames.
    pub frames: usize,
    /// The positions at the start, where all particles are at rest \[m\]; d·n numbers, particle after particle.
    pub positions: Vec<f64>,
    /// The masses \[kg\], n numbers.
    pub masses: Vec<f64>,
    /// 1 for a fixed particle, else 0; n numbers.
    pub fixed: Vec<u8>,
    /// The two particles of each rod, one pair after the other.
    pub ends: Vec<usize>,
    /// The length of each rod \[m\].
    pub lengths: Vec<f64>,
}

impl Workload {
    /// n, the number of particles.
    pub fn particle_count(&self) -> usize {
        self.masses.len()
    }

    /// Whether two seconds of motion would take minutes. Workloads of this size measure how the cost of a step grows.
    pub fn is_large(&self) -> bool {
        self.lengths.len() > 9_000
    }

    /// The two particles of every rod, with its length \[m\].
    pub fn rods(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        self.ends.chunks_exact(2).zip(&self.lengths).map(|(ends, &length)| (ends[0], ends[1], length))
    }

    /// The workload as a system of qhat.
    ///
    /// # Errors
    /// A matrix A that is too large for the engine.
    pub fn system(&self) -> Result<(System, State), BuildError> {
        self.builder().build()
    }

    /// The parts of the system. The ids of particles and rods count in their order.
    pub fn builder(&self) -> SystemBuilder {
        let mut builder = System::builder(if self.dimension == 2 { Dimension::Two } else { Dimension::Three });
        let ids: Vec<_> = (0..self.particle_count())
            .map(|i| {
                let position = &self.positions[i * self.dimension..][..self.dimension];
                let particle = Particle::at(format!("p{i}"), position).with_mass(self.masses[i]);
                builder.particle(if self.fixed[i] == 1 { particle.fixed() } else { particle })
            })
            .collect();
        for (row, (a, b, length)) in self.rods().enumerate() {
            builder.constraint(format!("rod{row}"), Distance::new(ids[a], ids[b], length));
        }
        let mut acceleration = [0.0; 3];
        acceleration[..self.dimension].copy_from_slice(&self.gravity);
        builder.force(Gravity { acceleration });
        builder
    }

    /// The workload as the JSON file that the other engines read.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("numbers and names are always JSON")
    }
}
