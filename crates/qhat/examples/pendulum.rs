//! A pendulum: model, step, look. `cargo run --example pendulum`

#![allow(clippy::disallowed_methods, reason = "the bits of these numbers need not be the same on every machine")]

use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    // Model: a bob of 2 kg on a rod of 1 m, 60° from straight down.
    let angle = f64::to_radians(60.0);
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [angle.sin(), -angle.cos()]).with_mass(2.0));
    let rod = builder.constraint("rod", Distance::new(pivot, bob, 1.0));
    builder.force(Gravity::new([0.0, -9.81]));
    let (system, state) = builder.build()?;
    let mut simulation = Simulation::new(system, state, Settings::default())?;

    // Step: frames of 0.01 s, until the bob is back where it started.
    let (mut tension, mut period) = (0.0_f64, None);
    while period.is_none() {
        let before = simulation.velocity(bob)[0];
        simulation.step()?;
        tension = tension.max(simulation.tension_of(rod).unwrap_or_default());
        let (after, time) = (simulation.velocity(bob)[0], simulation.state().time());
        // It turns round at the end of each swing, first on the other side.
        if before > 0.0 && after <= 0.0 {
            period = Some(time - 0.01 * after / (after - before));
        }
    }

    // Look.
    writeln!(out, "period {:.3} s", period.unwrap_or_default())?;
    writeln!(out, "tension at most {tension:.2} N, at rest {:.2} N", 2.0 * 9.81)?;
    writeln!(out, "the energy is right to {:.0e}", simulation.energy_error_max().max(1e-6))?;
    Ok(())
}
