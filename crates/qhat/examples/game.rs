//! A loop of 60 frames a second, and a hand that picks a particle and drags it. `cargo run --example game`

use qhat::{Dimension, Distance, Gravity, Particle, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    // A chain of 20 links with a heavy end, straight down.
    let mut builder = System::builder(Dimension::Two);
    let mut last = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    for i in 1..=20 {
        let mass = if i == 20 { 20.0 } else { 0.1 };
        let next = builder.particle(Particle::at(format!("bead{i}"), [0.0, -0.1 * f64::from(i)]).with_mass(mass));
        builder.constraint(format!("link{i}"), Distance::new(last, next, 0.1));
        last = next;
    }
    builder.force(Gravity::new([0.0, -9.81]));
    let (system, state) = builder.build()?;
    // Work that a frame may take before `auto` goes over to a method that is never late.
    let settings = Settings { h: 1.0 / 60.0, frame_work: 1_000_000, ..Settings::default() };
    let mut world = Simulation::new(system, state, settings)?;

    for frame in 0..120 {
        // The events of a window: the button goes down, the cursor moves, the button goes up.
        let cursor = [0.01 * f64::from(frame), -1.8];
        match frame {
            10 => {
                if let Some(particle) = world.nearest([0.05, -2.02], 0.2) {
                    writeln!(out, "picked {}", world.system().particle_names()[particle.index()])?;
                    world.grab(particle, cursor)?;
                }
            }
            11..80 => world.drag_to(cursor)?,
            80 => world.release(),
            _ => {}
        }
        let report = world.step()?;
        report.warnings.iter().try_for_each(|warning| writeln!(out, "{warning}"))?;
        if frame % 40 == 39 {
            let [x, y, _] = world.position(last);
            let stretch = report.max_relative_length_error;
            writeln!(out, "frame {frame}: end at ({x:.2}, {y:.2}), links right to 1e-9: {}", stretch < 1e-9)?;
        }
    }
    Ok(())
}
