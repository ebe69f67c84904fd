//! A workload in neutral form: what every engine is given, and nothing that belongs to one.

use qhat::{Dimension, Distance, Gravity, Particle, State, System};
use serde::Serialize;

/// Standard gravity as the workloads have it, downwards in y \[m/s²\].
pub(crate) const GRAVITY: f64 = 9.81;

/// Particles, rods and gravity, and how long to look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Workload {
    /// What it is called, for example `chain100`.
    pub name: String,
    /// d, 2 or 3.
    pub dimension: usize,
    /// g \[m/s²\], d numbers.
    pub gravity: Vec<f64>,
    /// Length of a frame \[s\]: every engine tells its state at the end of each.
    pub frame: f64,
    /// How many frames.
    pub frames: usize,
    /// Where the particles start, at rest \[m\]; d·n numbers, particle after particle.
    pub positions: Vec<f64>,
    /// \[kg\], n numbers.
    pub masses: Vec<f64>,
    /// 1 where a particle is held, else 0; n numbers.
    pub fixed: Vec<u8>,
    /// The two particles of each rod, one pair after the other.
    pub ends: Vec<usize>,
    /// The length of each rod \[m\].
    pub lengths: Vec<f64>,
}

impl Workload {
    /// n, how many particles.
    pub fn particle_count(&self) -> usize {
        self.masses.len()
    }

    /// Whether two seconds would take minutes: what is asked of such sizes is how the cost of a step grows.
    pub fn is_large(&self) -> bool {
        self.lengths.len() > 9_000
    }

    /// The two particles of every rod, with its length \[m\].
    pub fn rods(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        self.ends.chunks_exact(2).zip(&self.lengths).map(|(ends, &length)| (ends[0], ends[1], length))
    }

    /// The same as qhat has it.
    pub fn system(&self) -> (System, State) {
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
        builder.build().expect("shapes are made of finite numbers, names of counts")
    }

    /// The same in the file that every other engine reads.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("numbers and names are always JSON")
    }
}
