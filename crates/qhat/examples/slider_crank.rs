//! A slider-crank: a motor that turns as a function of time, and the torque that it takes.
//! `cargo run --example slider_crank`

use qhat::{Angle, Dimension, Distance, Driven, OnLine, Particle, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut builder = System::builder(Dimension::Two);
    let shaft = builder.particle(Particle::at("shaft", [0.0, 0.0]).fixed());
    let pin = builder.particle(Particle::at("pin", [0.05, 0.0]).with_mass(0.2));
    let piston = builder.particle(Particle::at("piston", [0.25, 0.0]).with_mass(0.5));
    builder.constraint("crank", Distance::new(shaft, pin, 0.05));
    builder.constraint("rod", Distance::new(pin, piston, 0.2));
    builder.constraint("cylinder", OnLine::fixed(piston, [0.0; 3], [1.0, 0.0, 0.0]));
    // Ten turns a second. The start is at rest, and is given the velocities of the motor.
    let turn = Driven::text("20*pi*t")?;
    let motor = builder.constraint("motor", Angle::from_direction([1.0, 0.0, 0.0], [shaft, pin], turn));
    let (system, state) = builder.build()?;
    let settings = Settings { h: 0.0025, ..Settings::default() };
    let mut engine = Simulation::new(system, state, settings)?;

    writeln!(out, "   t [s]  piston [m]  torque [N·m]")?;
    for _ in 0..8 {
        for _ in 0..5 {
            engine.step()?;
        }
        let time = engine.state().time();
        writeln!(out, "{time:8.4}  {:10.4}  {:12.3}", engine.position(piston)[0], engine.reaction(motor)[0])?;
    }
    writeln!(out, "work of the motor over a turn: {:.3} J", engine.energy().work.drives)?;
    Ok(())
}
