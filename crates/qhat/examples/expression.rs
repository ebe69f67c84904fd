//! A constraint and a force from text: a bead on the spiral r = a θ, in a wind that turns.
//! `cargo run --example expression`

#![allow(clippy::disallowed_methods, reason = "the bits of these numbers need not be the same on every machine")]

use qhat::{Dimension, ExpressionConstraint, ExpressionForce, Particle, Purpose, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    // θ = 2π, where r = 0.2 π.
    let start = [0.2 * std::f64::consts::PI, 0.0];
    let mut builder = System::builder(Dimension::Two);
    let bead = builder.particle(Particle::at("bead", start).with_mass(0.1));
    // The angle of the bead, less that of the spiral at its radius, seen from its turned axes: no jump at whole turns.
    let radius = "sqrt(bead.x^2 + bead.y^2)";
    let spiral = format!("bead.x*sin(10*{radius}) - bead.y*cos(10*{radius})");
    let spiral = builder.expression(Purpose::Constraint, &spiral)?;
    let wire = builder.constraint("spiral", ExpressionConstraint::new(spiral, &start));
    let force = |text: &str| builder.expression(Purpose::Force, text);
    let components = vec![force("cos(t) - 0.05*bead.vx")?, force("sin(t) - 0.05*bead.vy")?];
    builder.force(ExpressionForce { particle: bead, components });
    let (system, state) = builder.build()?;
    let mut simulation = Simulation::new(system, state, Settings::default())?;

    for second in 1..=4 {
        simulation.advance(1.0)?;
        let [x, y, _] = simulation.position(bead);
        writeln!(
            out,
            "{second} s: r = {:.4} m, the wire pushes with λ = {:.4}",
            x.hypot(y),
            simulation.reaction(wire)[0]
        )?;
    }
    let off = simulation.terms().residual[0].abs();
    writeln!(out, "off the spiral by less than 1e-9 m: {}", off < 1e-9)?;
    Ok(())
}
