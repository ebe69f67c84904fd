//! Links that break: by their tension, by the impulse of a blow, and elastic rods.

use crate::systems::{self, FRAME, G, gravity, settings};
use qhat::{
    ConstraintError, Dimension, Distance, Event, EventKind, Integrator, Limits, Particle, Settings, Simulation,
    StepReport, System, SystemBuilder,
};

fn accurate() -> Settings {
    Settings { tolerance: 1e-9, ..settings(Integrator::Dop853, FRAME) }
}

fn start(builder: SystemBuilder) -> Simulation {
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, accurate()).unwrap()
}

/// Runs for the given number of seconds and returns all reports in order.
fn run(simulation: &mut Simulation, seconds: f64) -> Vec<StepReport> {
    let frames = (seconds / FRAME).round() as usize;
    (0..frames).map(|frame| simulation.step().unwrap_or_else(|error| panic!("frame {frame}: {error}"))).collect()
}

fn events(reports: &[StepReport]) -> Vec<&Event> {
    reports.iter().flat_map(|report| &report.events).collect()
}

/// A rod that breaks at 2 m g breaks where 3 cos a = 2, and its bob flies on.
#[test]
fn a_rod_breaks_where_its_tension_passes_the_limit() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [1.0, 0.0]));
    builder.with_constraint("rod", Distance::new(pivot, bob, 1.0).breaking_at(2.0 * G)).force(gravity());
    let mut simulation = start(builder);
    let before = simulation.energy().total();
    let reports = run(&mut simulation, 1.0);
    let broke = events(&reports);
    assert_eq!(broke.len(), 1, "{broke:?}");
    assert_eq!(broke[0].kind, EventKind::Broke);
    // T = 3 m g sin a, where a is the angle through which the bob has fallen.
    let (system, state) = systems::pendulum(std::f64::consts::FRAC_PI_2);
    let mut whole = Simulation::new(system, state, accurate()).unwrap();
    whole.advance(broke[0].time).unwrap();
    let sine = -whole.state().positions()[3];
    assert!((sine - 2.0 / 3.0).abs() < 1e-8, "{sine}");
    assert!((simulation.energy().total() - before).abs() < 1e-9);
    assert_eq!(simulation.tension(), [0.0]);
}

/// 10 kg that fall a metre into a rope stop with an impulse of m √(2 g h). A rope that bears it stops them; a weaker
/// one breaks, and the load falls on as if there were no rope.
#[test]
fn an_impulse_breaks_a_rope_that_does_not_bear_it() {
    let impulse = 10.0 * (2.0 * G).sqrt();
    for (strength, breaks) in [(1.01 * impulse, false), (0.99 * impulse, true)] {
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let load = builder.particle(Particle::at("load", [0.0, -1.0]).with_mass(10.0));
        builder.with_constraint("rope", Limits::rope(hook, load, 2.0).breaking_at_impulse(strength)).force(gravity());
        let mut simulation = start(builder);
        let reports = run(&mut simulation, 1.0);
        let happened: Vec<_> = reports.iter().flat_map(|report| &report.events).collect();
        let first = happened.first().expect("the rope goes taut");
        // The time of the impact is good to 1e-10 m over the speed.
        assert!((first.impulse - impulse).abs() < 1e-8 && (first.time - (2.0 / G).sqrt()).abs() < 1e-10);
        assert_eq!(first.kind == EventKind::Broke, breaks, "{first:?}");
        let y = simulation.state().positions()[3];
        let expected = if breaks { -1.0 - 0.5 * G } else { -2.0 };
        assert!((y - expected).abs() < 1e-8, "{y} and not {expected}");
    }
}

/// Three ropes side by side share a load that grows by 10 N a second from 10 N. The weakest breaks at 30 N, at the end
/// of a frame; the others are then overloaded, and break at once.
#[test]
fn links_break_on_the_boundary_of_a_frame() {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, -1.0]));
    for (name, strength) in [("r0", 20.0), ("r1", 15.0), ("r2", 10.0)] {
        builder.constraint(name, Limits::rope(hook, load, 1.0).breaking_at(strength));
    }
    let pull = ["0", "-10 - 10*t"].map(|text| builder.expression(qhat::Purpose::Force, text).unwrap());
    builder.force(qhat::ExpressionForce { particle: load, components: pull.to_vec() });
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings { h: 0.01, ..accurate() }).unwrap();
    let reports: Vec<_> = (0..210).map(|_| simulation.step().unwrap()).collect();
    let events = reports.iter().flat_map(|report| &report.events);
    let broke: Vec<_> = events.filter(|event| event.kind == EventKind::Broke).collect();
    assert_eq!(broke.iter().map(|event| event.constraint.as_str()).collect::<Vec<_>>(), ["r2", "r1", "r0"]);
    // A billionth of the strength is reached after 1e-9 s.
    assert!(broke.iter().all(|event| (event.time - 2.0).abs() < 5e-9), "{broke:?}");
}

/// A mass that is let go at the rest length of an elastic rod falls to y = −(m g/k)(1 − cos ω t), with the tension
/// T = m g (1 − cos ω t), k = 1/α, ω² = k/m. At T = 3/2 m g the rod breaks, at ω t = 2π/3. The mass then falls freely,
/// and the energy α T²/2 that the rod held is lost.
#[test]
fn an_elastic_rod_breaks_where_its_tension_passes_the_limit() {
    let (mass, compliance) = (2.0, 1e-3);
    let weight = mass * G;
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, -1.0]).with_mass(mass));
    let rod = Distance::new(hook, load, 1.0).with_compliance(compliance, 0.0).breaking_at(1.5 * weight);
    builder.with_constraint("rod", rod).force(gravity());
    let mut simulation = start(builder);
    let before = simulation.energy().total();
    let reports = run(&mut simulation, 0.5);
    let broke = events(&reports);
    assert_eq!(broke.iter().map(|event| event.kind).collect::<Vec<_>>(), [EventKind::Broke]);
    let omega = (1.0 / (compliance * mass)).sqrt();
    let when = 2.0 / 3.0 * std::f64::consts::PI / omega;
    // The tolerance of 1e-9 of the motion, over the rate of the tension.
    assert!((broke[0].time - when).abs() < 1e-9, "{} and not {when}", broke[0].time);
    let sag = 1.5 * weight * compliance;
    let speed = weight * compliance * omega * (0.75_f64).sqrt();
    let flight = simulation.state().time() - when;
    let expected = -1.0 - sag - speed * flight - 0.5 * G * flight * flight;
    let y = simulation.state().positions()[3];
    assert!((y - expected).abs() < 1e-8, "{y} and not {expected}");
    assert_eq!(simulation.tension(), [0.0]);
    assert_eq!(simulation.system().broken_links(simulation.state()), [0]);
    let held = 0.5 * compliance * (1.5 * weight) * (1.5 * weight);
    let lost = before - simulation.energy().total();
    assert!((lost - held).abs() < 1e-7 * held, "{lost} and not {held}");
    assert!(simulation.energy_error().abs() < 1e-8, "{:e}", simulation.energy_error());
}

/// The hook no longer feels a rod that broke, whether a damper stands beside its compliance or not.
#[test]
fn a_broken_elastic_rod_carries_nothing() {
    for damping in [0.0, 20.0] {
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let load = builder.particle(Particle::at("load", [0.0, -1.0]));
        let rod = Distance::new(hook, load, 1.0).with_compliance(1e-2, damping).breaking_at(0.5 * G);
        builder.with_constraint("rod", rod).force(gravity());
        let mut simulation = start(builder);
        let reports = run(&mut simulation, 0.5);
        assert_eq!(events(&reports).len(), 1, "damping {damping}");
        assert_eq!((simulation.support(hook), simulation.tension()), ([0.0; 3], vec![0.0]), "damping {damping}");
        let fall = simulation.terms().accelerations[3];
        assert!((fall + G).abs() < 1e-12, "damping {damping}: {fall}");
        // 1e-9 of the motion for each of 50 frames.
        assert!(simulation.energy_error().abs() < 1e-7, "damping {damping}: {:e}", simulation.energy_error());
    }
}

/// Of three elastic ropes of one length the stiffest carries most, and breaks first; the load of the others then rises.
#[test]
fn elastic_rods_break_one_after_the_other() {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, -1.0]));
    for (name, stiffness) in [("soft", 1e3), ("hard", 3e3)] {
        builder
            .constraint(name, Distance::new(hook, load, 1.0).with_compliance(1.0 / stiffness, 5.0).breaking_at(30.0));
    }
    let pull = ["0", "-10*t"].map(|text| builder.expression(qhat::Purpose::Force, text).unwrap());
    builder.force(qhat::ExpressionForce { particle: load, components: pull.to_vec() });
    let mut simulation = start(builder);
    let reports = run(&mut simulation, 5.0);
    let broke: Vec<_> = events(&reports).iter().map(|event| (event.constraint.clone(), event.kind)).collect();
    assert_eq!(broke, [("hard".to_owned(), EventKind::Broke), ("soft".to_owned(), EventKind::Broke)]);
}

#[test]
fn no_impulse_breaks_an_elastic_rod() {
    let mut builder = System::builder(Dimension::Two);
    let ends = [0.0, 1.0].map(|x| builder.particle(Particle::at(format!("{x}"), [x, 0.0])));
    let rod = Distance::new(ends[0], ends[1], 1.0).with_compliance(0.1, 0.0).breaking_at_impulse(1.0);
    builder.constraint("rod", rod);
    let refused = builder.build().map(|_| ()).unwrap_err().to_string();
    assert!(refused.contains(&ConstraintError::ComplianceTakesNoBlow.to_string()), "{refused}");
}
