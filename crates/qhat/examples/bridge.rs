//! A truss on two supports: tensions, loads on the ground, and the rod that breaks first.
//! `cargo run --example bridge`

#![allow(clippy::disallowed_methods, reason = "the bits of these numbers need not be the same on every machine")]

use qhat::{Dimension, Distance, Drag, EventKind, Gravity, OnLine, Particle, PointForce, Settings, Simulation, System};
use std::error::Error;
use std::io::{Write, stdout};

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut stdout())
}

/// Panels of 1 m.
const PANELS: usize = 6;
/// The tension or thrust that no rod survives [N].
const STRENGTH: f64 = 2500.0;

pub(crate) fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut builder = System::builder(Dimension::Two);
    let deck: Vec<_> = (0..=PANELS)
        .map(|i| Particle::at(format!("deck{i}"), [i as f64, 0.0]).with_mass(10.0))
        .map(|particle| builder.particle(if particle.name == "deck0" { particle.fixed() } else { particle }))
        .collect();
    let top: Vec<_> = (0..PANELS)
        .map(|i| builder.particle(Particle::at(format!("top{i}"), [i as f64 + 0.5, 0.8]).with_mass(10.0)))
        .collect();
    let slope = f64::hypot(0.5, 0.8);
    for i in 0..PANELS {
        let mut rod = |name: String, a, b, length| {
            builder.constraint(name, Distance::new(a, b, length).breaking_at(STRENGTH));
        };
        rod(format!("deck{i}-{}", i + 1), deck[i], deck[i + 1], 1.0);
        rod(format!("up{i}"), deck[i], top[i], slope);
        rod(format!("down{i}"), top[i], deck[i + 1], slope);
        if i + 1 < PANELS {
            rod(format!("top{i}-{}", i + 1), top[i], top[i + 1], 1.0);
        }
    }
    // The right end rests on a roller.
    let roller = builder.constraint("roller", OnLine::fixed(deck[PANELS], [0.0; 3], [1.0, 0.0, 0.0]));
    builder.with_force(Gravity::new([0.0, -9.81])).with_force(Drag { coefficient: 5.0 });
    let load = builder.named_force("load", PointForce::new(deck[PANELS / 2], [0.0, -500.0]));
    let (system, state) = builder.build()?;
    let mut bridge = Simulation::new(system, state, Settings::default())?;

    let mut forces: Vec<_> = bridge.links().map(|(link, tension)| (link.name.to_owned(), tension)).collect();
    forces.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (thrust, pull) = (&forces[0], &forces[forces.len() - 1]);
    writeln!(out, "pulled most: {} with {:.0} N", pull.0, pull.1)?;
    writeln!(out, "pushed most: {} with {:.0} N", thrust.0, -thrust.1)?;
    let ground = bridge.support(deck[0]);
    writeln!(out, "left support: {:.1} N down", -ground[1])?;
    writeln!(out, "right support: {:.1} N down", bridge.reaction(roller)[0].abs())?;

    // More and more, until something breaks.
    let mut weight = 500.0;
    loop {
        weight += 50.0;
        bridge.set_force(load, PointForce::new(deck[PANELS / 2], [0.0, -weight]))?;
        let report = bridge.step()?;
        if let Some(event) = report.events.iter().find(|event| event.kind == EventKind::Broke) {
            writeln!(out, "{} breaks under a load of {weight} N", event.constraint)?;
            return Ok(());
        }
    }
}
