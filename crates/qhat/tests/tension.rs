//! Tension of ropes and struts: m g if a weight hangs from a rope or stands on a strut, zero if the rope or strut is
//! slack.

use crate::systems::dense::assert_close;
use crate::systems::{G, gravity, settings};
use qhat::{
    Dimension, Distance, EventKind, Integrator, Limits, Nail, Particle, ParticleId, Settings, Simulation, System,
    SystemBuilder,
};

const MASS: f64 = 3.0;

/// A weight on a rope or a strut from a fixed particle, after one frame: a link that starts at its limit acts from the
/// first step on.
fn after_a_frame(at: [f64; 2], limits: impl Fn(ParticleId, ParticleId) -> Limits) -> Simulation {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", at).with_mass(MASS));
    builder.with_constraint("link", limits(pivot, bob)).force(gravity());
    start(builder)
}

fn start(builder: SystemBuilder) -> Simulation {
    let (system, state) = builder.build().unwrap();
    let settings = Settings { tolerance: 1e-9, ..settings(Integrator::Dop853, 0.01) };
    let mut simulation = Simulation::new(system, state, settings).unwrap();
    simulation.step().unwrap();
    simulation
}

#[test]
fn a_weight_on_a_rope_pulls_it_with_m_g() {
    let ropes = [
        after_a_frame([0.0, -1.0], |a, b| Limits::rope(a, b, 1.0)),
        after_a_frame([0.0, -1.0], |a, b| Limits::between(a, b, 0.5, 1.0)),
    ];
    for mut simulation in ropes {
        let terms = simulation.terms();
        assert_close("tension", terms.tension[0], MASS * G, 1e-12 * MASS * G);
        assert_eq!(terms.multipliers[0], terms.tension[0], "λ of the longest");
    }
}

/// The tension is known before the first step if the contact does not close.
#[test]
fn a_rope_that_starts_taut_pulls_from_the_start() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_mass(MASS));
    builder.with_constraint("rope", Limits::rope(pivot, bob, 1.0)).force(gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, settings(Integrator::Dop853, 0.01)).unwrap();
    assert_close("tension", simulation.tension()[0], MASS * G, 1e-12 * MASS * G);
}

/// A pendulum on a rope or a strut, released from the horizontal, carries 3 m g cos a. At twice its weight it breaks at
/// the same place as a rod.
#[test]
fn a_broken_link_is_slack_from_then_on() {
    let limits: [fn(ParticleId, ParticleId) -> Limits; 2] =
        [|a, b| Limits::rope(a, b, 1.0), |a, b| Limits::between(a, b, 0.5, 1.0)];
    for make in limits {
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [1.0, 0.0]).with_mass(MASS));
        builder
            .with_constraint("link", Limits { breaks_at: Some(2.0 * MASS * G), ..make(pivot, bob) })
            .force(gravity());
        let mut simulation = start(builder);
        let mut broke = None;
        for _ in 0..100 {
            let report = simulation.step().unwrap();
            broke = broke.or(report.events.into_iter().find(|event| event.kind == EventKind::Broke));
        }
        let broke = broke.expect("it carries more than it can");
        assert_eq!(simulation.system().broken_links(simulation.state()), [0]);
        assert_eq!(simulation.tension(), [0.0]);
        // The bob flies from there: 2/3 m below the pivot, at the speed √(2 g 2/3).
        let t = simulation.state().time() - broke.time;
        let (sin, cos) = ((1.0_f64 - 4.0 / 9.0).sqrt(), 2.0 / 3.0);
        let speed = (2.0 * G * cos).sqrt();
        let (x, y) = (sin - speed * cos * t, -cos - speed * sin * t - 0.5 * G * t * t);
        let q = &simulation.state().positions()[2..];
        assert_close("x", q[0], x, 1e-8);
        assert_close("y", q[1], y, 1e-8);
    }
}

#[test]
fn a_slack_rope_has_none() {
    let mut simulation = after_a_frame([0.0, -0.9], |a, b| Limits::rope(a, b, 1.0));
    assert_eq!(simulation.tension()[0].to_bits(), 0.0_f64.to_bits(), "0 and not −0");
}

#[test]
fn a_weight_on_a_strut_pushes_it_with_m_g() {
    let struts = [
        after_a_frame([0.0, 1.0], |a, b| Limits::strut(a, b, 1.0)),
        after_a_frame([0.0, 1.0], |a, b| Limits::between(a, b, 1.0, 2.0)),
    ];
    for mut simulation in struts {
        assert_close("tension", simulation.tension()[0], -MASS * G, 1e-12 * MASS * G);
    }
}

/// Links and tensions have the same order, also with other constraints between the links.
#[test]
fn links_are_in_the_order_of_tension() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]));
    let hung =
        [1.0, 2.0, 4.0].map(|mass| builder.particle(Particle::at(format!("{mass}"), [0.0, -mass]).with_mass(mass)));
    builder.constraint("rope", Limits::between(pivot, hung[0], 0.5, 1.0));
    builder.constraint("nail", Nail::new(pivot, [0.0; 3]));
    builder.constraint("rod", Distance::new(pivot, hung[1], 2.0));
    builder.with_constraint("strut", Limits::strut(hung[1], hung[2], 1.0)).force(gravity());
    let mut simulation = start(builder);
    let terms = simulation.terms();
    let links: Vec<_> = simulation.system().links().collect();
    assert_eq!(links.len(), terms.tension.len());
    let seen: Vec<_> = links.iter().map(|link| (link.name, link.rows.clone(), link.is_rod())).collect();
    assert_eq!(seen, [("rope", 0..2, false), ("rod", 4..5, true), ("strut", 5..6, false)]);
    assert_eq!((links[0].shortest, links[0].longest), (Some(0.5), Some(1.0)));
    assert_eq!((links[1].shortest, links[2].longest), (Some(2.0), None));
    // The last particle is 2 m below the particle before it: nothing holds it.
    for (tension, mass) in terms.tension.iter().zip([1.0, 2.0, 0.0]) {
        assert_close("tension", *tension, mass * G, 1e-12 * G);
    }
}
