//! Rapier in f64, in the plane and in space. The same protocol as benches/peers/python/adapter.py:
//! `rapier-peer WORKLOAD.json LIMIT OUTPUT key=value …` prints CPU seconds of the steps and the reason of an early end.
//!
//! ```text
//! substeps     steps a frame
//! iterations   of the solver a step, each a small step of its own (Rapier's default is 4)
//! joint        hinge: its idiom for a chain, which turns about the particle before; tree: the same as an articulated
//!              multibody (both chains only); spring: a rod between any two particles, as stiff as can be
//! ```

use cpu_time::ProcessTime;
use serde::Deserialize;
use std::collections::HashMap;
use std::error::Error;
use std::{env, fs};

mod plane {
    use rapier::prelude::*;
    pub use rapier2d_f64 as rapier;

    pub const D: usize = 2;

    pub fn vector(numbers: &[f64]) -> Vector {
        Vector::new(numbers[0], numbers[1])
    }

    pub fn numbers(vector: Vector) -> [f64; D] {
        [vector.x, vector.y]
    }

    pub fn mass_properties(mass: f64, inertia: f64) -> MassProperties {
        MassProperties::new(Vector::ZERO, mass, inertia)
    }

    pub fn hinge(apart: Vector) -> RevoluteJoint {
        RevoluteJointBuilder::new().local_anchor2(apart).build()
    }

    pub mod engine {
        include!("engine.rs");
    }
}

mod space {
    use rapier::prelude::*;
    pub use rapier3d_f64 as rapier;

    pub const D: usize = 3;

    pub fn vector(numbers: &[f64]) -> Vector {
        Vector::new(numbers[0], numbers[1], numbers[2])
    }

    pub fn numbers(vector: Vector) -> [f64; D] {
        [vector.x, vector.y, vector.z]
    }

    pub fn mass_properties(mass: f64, inertia: f64) -> MassProperties {
        MassProperties::new(Vector::ZERO, mass, Vector::splat(inertia))
    }

    pub fn hinge(apart: Vector) -> SphericalJoint {
        SphericalJointBuilder::new().local_anchor2(apart).build()
    }

    pub mod engine {
        include!("engine.rs");
    }
}

/// Number of runs if a run takes under a second; the fastest counts.
const RUNS: usize = 3;

/// Particles, rods and gravity of the neutral file.
#[derive(Deserialize)]
pub struct Workload {
    dimension: usize,
    gravity: Vec<f64>,
    frame: f64,
    frames: usize,
    positions: Vec<f64>,
    masses: Vec<f64>,
    fixed: Vec<u8>,
    ends: Vec<usize>,
    lengths: Vec<f64>,
}

/// The arguments key=value.
pub struct Setting(HashMap<String, String>);

impl Setting {
    fn word(&self, key: &str) -> &str {
        self.0.get(key).unwrap_or_else(|| panic!("say {key}=…"))
    }

    fn number(&self, key: &str) -> usize {
        self.word(key).parse().unwrap_or_else(|_| panic!("{key} must be a count"))
    }
}

/// A motion: `step` advances by a frame.
pub trait Engine {
    fn step(&mut self);
    fn read(&self) -> (Vec<f64>, Vec<f64>);
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = env::args().skip(1).collect();
    let [path, limit, output, settings @ ..] = &words[..] else {
        return Err("WORKLOAD LIMIT OUTPUT key=value …".into());
    };
    let workload: Workload = serde_json::from_str(&fs::read_to_string(path)?)?;
    let limit: f64 = limit.parse()?;
    let pairs = settings.iter().filter_map(|word| word.split_once('='));
    let setting = Setting(pairs.map(|(key, value)| (key.to_owned(), value.to_owned())).collect());
    let (mut total, mut best) = (0.0, f64::INFINITY);
    let (mut ended, mut bytes) = (String::new(), Vec::new());
    for _ in 0..RUNS {
        let mut engine: Box<dyn Engine> = match workload.dimension {
            2 => Box::new(plane::engine::World::new(&workload, &setting)),
            _ => Box::new(space::engine::World::new(&workload, &setting)),
        };
        let cpu;
        (cpu, ended, bytes) = simulate(&workload, engine.as_mut(), limit);
        total += cpu;
        best = cpu.min(best);
        if !ended.is_empty() || total > 1.0 {
            break;
        }
    }
    fs::write(output, bytes)?;
    println!("{best} {ended}");
    Ok(())
}

fn simulate(workload: &Workload, engine: &mut dyn Engine, limit: f64) -> (f64, String, Vec<u8>) {
    let (mut cpu, mut bytes) = (0.0, Vec::new());
    for count in 1..=workload.frames {
        let clock = ProcessTime::now();
        engine.step();
        cpu += clock.elapsed().as_secs_f64();
        let (positions, velocities) = engine.read();
        if !positions.iter().chain(&velocities).all(|number| number.is_finite()) {
            return (cpu, "diverged".into(), bytes);
        }
        bytes.extend(positions.iter().chain(&velocities).flat_map(|number| number.to_le_bytes()));
        // After a tenth of the limit it is clear whether a run will take one and a half times the limit.
        let estimate = cpu / count as f64 * workload.frames as f64;
        if count < workload.frames && (cpu > limit || (cpu > limit / 10.0 && estimate > 1.5 * limit)) {
            return (cpu, format!("too slow: about {estimate:.0} s of CPU time"), bytes);
        }
    }
    (cpu, String::new(), bytes)
}
