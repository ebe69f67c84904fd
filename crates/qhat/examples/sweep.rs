//! Many simulations on every core: the largest tension over a range of lengths. `cargo run --release --example sweep`

use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System, run_all};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

/// A double pendulum from the horizontal, whose second rod has a length [m].
fn double_pendulum(length: f64) -> Result<Simulation, Box<dyn Error>> {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let elbow = builder.particle(Particle::at("elbow", [1.0, 0.0]));
    let tip = builder.particle(Particle::at("tip", [1.0 + length, 0.0]));
    builder.constraint("upper", Distance::new(pivot, elbow, 1.0));
    builder.constraint("lower", Distance::new(elbow, tip, length));
    let (system, state) = builder.with_force(Gravity::new([0.0, -9.81])).build()?;
    Ok(Simulation::new(system, state, Settings::default())?)
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let lengths: Vec<f64> = (0..50).map(|i| 0.5 + 0.02 * f64::from(i)).collect();
    let mut pendulums = lengths.iter().map(|&length| double_pendulum(length)).collect::<Result<Vec<_>, _>>()?;
    // One second each, in frames of 0.01 s.
    let tensions = run_all(&mut pendulums, 100, |_, pendulum, _| pendulum.tension()[0]);

    let mut worst = (0.0, 0.0);
    for (length, tensions) in lengths.iter().zip(tensions) {
        let largest = tensions?.into_iter().fold(0.0, f64::max);
        if largest > worst.0 {
            worst = (largest, *length);
        }
    }
    writeln!(out, "of {} lengths, {:.2} m pulls most at the pivot: {:.1} N", lengths.len(), worst.1, worst.0)?;
    Ok(())
}
