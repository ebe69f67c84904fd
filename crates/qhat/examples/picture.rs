//! A picture as SVG: links coloured by their tension. `cargo run --example picture > swing.svg`

#![allow(clippy::disallowed_methods, reason = "the bits of these numbers need not be the same on every machine")]

use qhat::{Dimension, Distance, Gravity, Particle, ParticleId, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let left = builder.particle(Particle::at("left", [-0.5, -1.0]));
    let right = builder.particle(Particle::at("right", [0.5, -1.0]).with_mass(4.0));
    builder.constraint("pivot-left", Distance::new(pivot, left, f64::hypot(0.5, 1.0)));
    builder.constraint("pivot-right", Distance::new(pivot, right, f64::hypot(0.5, 1.0)));
    builder.constraint("bar", Distance::new(left, right, 1.0));
    builder.force(Gravity::new([0.0, -9.81]));
    let (system, state) = builder.build()?;
    let mut swing = Simulation::new(system, state, Settings::default())?;
    swing.advance(0.4)?;

    // Pixels: 100 a metre, y down.
    let places: Vec<[f64; 3]> = swing.system().particles().map(|particle| swing.position(particle)).collect();
    let pixel = |particle: ParticleId| (100.0 * places[particle.index()][0], -100.0 * places[particle.index()][1]);
    let largest = swing.tension().iter().fold(1e-12, |most: f64, tension| most.max(tension.abs()));
    writeln!(out, "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-100 -20 200 160'>")?;
    for (link, tension) in swing.links() {
        let ((x1, y1), (x2, y2)) = (pixel(link.a), pixel(link.b));
        let strength = 255.0 * tension.abs() / largest;
        let color = if tension > 0.0 { format!("rgb({strength:.0},0,0)") } else { format!("rgb(0,0,{strength:.0})") };
        write!(out, "<line x1='{x1:.1}' y1='{y1:.1}' x2='{x2:.1}' y2='{y2:.1}' stroke='{color}'>")?;
        writeln!(out, "<title>{} {tension:.1} N</title></line>", link.name)?;
    }
    for particle in swing.system().particles() {
        let (x, y) = pixel(particle);
        let radius = 3.0 * swing.system().masses()[particle.index()].cbrt();
        let color = if swing.system().is_fixed(particle) { "black" } else { "gray" };
        writeln!(out, "<circle cx='{x:.1}' cy='{y:.1}' r='{radius:.1}' fill='{color}'/>")?;
    }
    writeln!(out, "</svg>")?;
    Ok(())
}
