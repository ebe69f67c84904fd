//! A rope that goes taut with a jerk: events with their times. `cargo run --example slack_rope`

use qhat::{Dimension, EventKind, Gravity, Obstacle, Particle, Rope, Settings, Simulation, Surface, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    // Thrown to the side, it falls until the rope of 1.5 m stops it.
    let ball = builder.particle(Particle::at("ball", [0.5, 0.0]).with_velocity([1.0, 0.0]));
    let rope = builder.constraint("rope", Rope::new(hook, ball, 1.5));
    let wall = Surface::half_space([1.0, 0.0], -0.8);
    builder.constraint("wall", Obstacle::new(ball, wall).with_restitution(0.6));
    builder.force(Gravity::new([0.0, -9.81]));
    let (system, state) = builder.build()?;
    let mut simulation = Simulation::new(system, state, Settings::default())?;

    for _ in 0..200 {
        let report = simulation.step()?;
        for event in &report.events {
            write!(out, "{:.4} s: {} {}", event.time, event.constraint, event.kind)?;
            if let EventKind::Impact { speed } = event.kind {
                write!(out, " at {speed:.3} m/s")?;
            }
            writeln!(out)?;
        }
    }
    writeln!(out, "after 2 s the rope bears {:.2} N", simulation.tension_of(rope).unwrap_or_default())?;
    Ok(())
}
