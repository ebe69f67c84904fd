//! Contacts, ropes, friction and breaking constraints against closed forms.

use crate::systems::{self, FRAME, G, gravity, settings};
use qhat::{
    Dimension, Distance, EventKind, Integrator, Limits, Obstacle, Particle, Settings, Simulation, StepError,
    StepReport, Surface, System, SystemBuilder,
};

fn ground() -> Surface {
    Surface::HalfSpace { normal: [0.0, 1.0, 0.0], offset: 0.0 }
}

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

fn events(reports: &[StepReport]) -> Vec<(f64, EventKind)> {
    reports.iter().flat_map(|report| &report.events).map(|event| (event.time, event.kind)).collect()
}

/// A particle that is dropped from a height H with restitution e hits the ground at √(2H/g)(1 + 2e + 2e² + …), and
/// rests after the sum of the whole series.
#[test]
fn bounces_come_when_they_should() {
    let (height, e) = (1.0, 0.5);
    let mut builder = System::builder(Dimension::Two);
    let ball = builder.particle(Particle::at("ball", [0.0, height]));
    builder.with_constraint("ground", Obstacle { restitution: e, ..Obstacle::new(ball, ground()) }).force(gravity());
    let mut simulation = start(builder);
    let reports = run(&mut simulation, 2.0);
    let fall = (2.0 * height / G).sqrt();
    let impacts = events(&reports).into_iter().filter_map(|(time, kind)| match kind {
        EventKind::Impact { speed } => Some((time, speed)),
        _ => None,
    });
    let impacts: Vec<(f64, f64)> = impacts.collect();
    assert!(impacts.len() > 8, "{impacts:?}");
    let (mut expected, mut flight) = (fall, 2.0 * fall * e);
    for (k, (time, speed)) in impacts.iter().enumerate().take(8) {
        // The impact is located to a gap of 1e-10 m, divided by the speed.
        assert!((time - expected).abs() < 1e-10 / speed, "impact {k} at {time}, expected {expected}");
        assert!((speed - G * fall * libm::pow(e, k as f64)).abs() < 1e-9, "impact {k}: {speed} m/s");
        expected += flight;
        flight *= e;
    }
    assert!(simulation.state().positions()[1].abs() < 1e-10);
    assert!(simulation.state().velocities()[1].abs() < 1e-12);
    // The account of energy contains all losses.
    assert!(simulation.energy_error().abs() < 1e-9, "{:e}", simulation.energy_error());
}

/// A particle on a slope of angle a sticks if tan a < μ; else it slides with the acceleration g (sin a − μ cos a).
#[test]
fn coulomb_on_a_slope() {
    for (angle, mu) in [(0.3, 0.4), (0.3, 0.3), (0.3, 0.1), (1.2, 2.0), (0.5, 0.546)] {
        let (sin, cos) = libm::sincos(angle);
        for dimension in [Dimension::Two, Dimension::Three] {
            let mut builder = System::builder(dimension);
            let block = builder.particle(Particle::at("block", vec![0.0; dimension.number()]));
            let surface = Surface::HalfSpace { normal: [sin, cos, 0.0], offset: 0.0 };
            builder
                .with_constraint("slope", Obstacle { friction: mu, ..Obstacle::new(block, surface) })
                .force(gravity());
            let mut simulation = start(builder);
            run(&mut simulation, 1.0);
            let q = simulation.state().positions();
            let gone = libm::hypot(q[0], q[1]);
            let expected = 0.5 * G * (sin - mu * cos).max(0.0);
            // The tolerance of a substep, 1e-9 of a metre; the force is constant, so little of it is used.
            assert!((gone - expected).abs() < 1e-9, "{angle} {mu}: {gone} m, expected {expected}");
            assert!(simulation.energy_error_max() < 1e-9, "{:e}", simulation.energy_error_max());
        }
    }
}

/// A particle that is thrown along the ground stops after v²/(2 μ g), and stays.
#[test]
fn a_sliding_particle_stops() {
    let (v, mu) = (3.0, 0.4);
    for direction in [[1.0, 0.0], [0.6, 0.8]] {
        let mut builder = System::builder(Dimension::Three);
        let puck = Particle::at("puck", [0.0; 3]).with_velocity([v * direction[0], 0.0, v * direction[1]]);
        let puck = builder.particle(puck);
        builder.with_constraint("ice", Obstacle { friction: mu, ..Obstacle::new(puck, ground()) }).force(gravity());
        let mut simulation = start(builder);
        let reports = run(&mut simulation, 2.0);
        let q = simulation.state().positions();
        let far = v * v / (2.0 * mu * G);
        // Ten tolerances of a substep: the sliding, and the event at its end.
        assert!((q[0] - far * direction[0]).abs() < 1e-8 && (q[2] - far * direction[1]).abs() < 1e-8, "{q:?}, {far}");
        let stuck: Vec<_> = events(&reports).into_iter().filter(|(_, kind)| *kind == EventKind::Stuck).collect();
        assert_eq!(stuck.len(), 1, "{:?}", events(&reports));
        assert!((stuck[0].0 - v / (mu * G)).abs() < 1e-8, "{stuck:?}");
        assert_eq!(simulation.state().velocities(), [0.0; 3], "at rest");
    }
}

/// A bob that starts level with the pivot at half a rope's length falls freely, goes taut, and swings.
#[test]
fn a_rope_goes_taut_and_holds() {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.5, 0.0]));
    builder.with_constraint("rope", Limits::rope(pivot, bob, 1.0)).force(gravity());
    let mut simulation = start(builder);
    let reports = run(&mut simulation, 3.0);
    let taut = (2.0 * (0.75_f64).sqrt() / G).sqrt();
    let (time, kind) = events(&reports)[0];
    // A free fall is exact; the gap of 1e-10 m is crossed at some 3 m/s.
    assert!((time - taut).abs() < 1e-9, "{time}, expected {taut}");
    let EventKind::Impact { speed } = kind else { panic!("{kind:?}") };
    assert!((speed - G * taut * 0.75_f64.sqrt()).abs() < 1e-8, "{speed}");
    let q = simulation.state().positions();
    assert!(libm::hypot(q[2], q[3]) <= 1.0 + 1e-10);
    // 3 s of substeps at the tolerance of 1e-9.
    assert!(simulation.energy_error().abs() < 1e-8, "{:e}", simulation.energy_error());
}

/// With v² < 5 g r at the bottom of a loop, the rope goes slack at the height at which v² has fallen to −g r cos.
#[test]
fn a_rope_goes_slack_where_its_tension_ends() {
    let v2 = 3.5 * G;
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]).with_velocity([v2.sqrt(), 0.0]));
    builder.with_constraint("rope", Limits::rope(pivot, bob, 1.0)).force(gravity());
    let mut simulation = start(builder);
    let mut opened = None;
    for _ in 0..120 {
        let before = simulation.clone();
        let report = simulation.step().unwrap();
        if let Some(event) = report.events.iter().find(|event| event.kind == EventKind::Opened) {
            let mut there = before;
            there.advance(event.time - there.state().time()).unwrap();
            opened = Some(there.state().positions()[3]);
            break;
        }
    }
    // Height y above the pivot: v² = v₀² − 2g(1 + y) and T = v² − g y = 0 give y = (v₀²/g − 2)/3.
    let expected = (3.5 - 2.0) / 3.0;
    assert!((opened.unwrap() - expected).abs() < 1e-8, "{opened:?}, expected {expected}");
}

#[test]
fn integrators_without_events_say_so() {
    for integrator in Integrator::ALL {
        let mut builder = System::builder(Dimension::Two);
        let ball = builder.particle(Particle::at("ball", [0.0, 1.0]));
        builder.constraint("ground", Obstacle::new(ball, ground()));
        let (system, state) = builder.build().unwrap();
        let outcome = Simulation::new(system, state, settings(integrator, FRAME)).map(|_| ());
        let refused = matches!(outcome, Err(StepError::NoEvents { .. }));
        assert_eq!(refused, !integrator.finds_events(), "{integrator}: {outcome:?}");
    }
}

/// The lowest point of all particles, and the energy, over a run.
fn settle(builder: SystemBuilder, seconds: f64) -> (Simulation, f64, f64) {
    let mut simulation = start(builder);
    let mut energy = simulation.energy().total();
    let (mut lowest, mut risen) = (0.0_f64, 0.0_f64);
    for frame in 0..(seconds / FRAME) as usize {
        simulation.step().unwrap_or_else(|error| panic!("frame {frame}: {error}"));
        let now = simulation.energy().total();
        risen = risen.max(now - energy);
        energy = now;
        lowest = simulation.state().positions().chunks(2).fold(lowest, |lowest, x| lowest.min(x[1]));
    }
    (simulation, lowest, risen)
}

/// A deck of struts hung from ropes on towers of rods, dropped on the ground with friction.
fn bridge() -> SystemBuilder {
    let mut builder = System::builder(Dimension::Two);
    let mut deck = Vec::new();
    for k in 0..9 {
        deck.push(builder.particle(Particle::at(format!("deck{k}"), [k as f64, 1.0])));
    }
    let towers = [2, 6].map(|k| {
        let top = builder.particle(Particle::at(format!("top{k}"), [k as f64, 3.5]));
        let foot = builder.particle(Particle::at(format!("foot{k}"), [k as f64, 0.2]));
        (k, top, foot)
    });
    for k in 0..8 {
        builder.constraint(format!("plank{k}"), Limits::between(deck[k], deck[k + 1], 0.98, 1.02));
    }
    for (k, top, foot) in towers {
        builder.constraint(format!("mast{k}"), Distance::new(top, foot, 3.3));
        for i in 0..9 {
            if (i as i32 - k as i32).abs() <= 2 && i != k {
                let length = ((i as f64 - k as f64) * (i as f64 - k as f64) + 2.5 * 2.5).sqrt() * 1.01;
                builder.constraint(format!("stay{k}-{i}"), Limits::rope(top, deck[i], length));
            }
        }
    }
    let count = deck.len() + 4;
    for i in 0..count {
        let obstacle = Obstacle { friction: 0.5, restitution: 0.3, ..Obstacle::new(systems::id(i), ground()) };
        builder.constraint(format!("ground{i}"), obstacle);
    }
    builder.force(gravity());
    builder
}

#[test]
fn long_a_bridge_of_ropes_and_struts_comes_to_rest() {
    let (simulation, lowest, risen) = settle(bridge(), 10.0);
    // An open contact closes within 1e-10 of its scale; a hundred of that is still invisible.
    assert!(lowest > -1e-8, "{lowest:e}");
    // 1e-9 is the tolerance of a substep, relative to energies of some 100 J.
    assert!(risen < 1e-9, "{risen:e} J");
    let fastest = simulation.state().velocities().iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    assert!(fastest < 1e-6, "{fastest:e} m/s");
}

/// Three balls in a line on ice, the first of them thrown at the other two.
fn row_of_balls(gap: f64) -> Simulation {
    let mut builder = System::builder(Dimension::Two);
    let places = [0.0, 0.2, 0.3 + gap];
    let balls: Vec<_> = places
        .iter()
        .enumerate()
        .map(|(i, &x)| {
            let speed = if i == 0 { 1.0 } else { 0.0 };
            builder.particle(Particle::at(format!("ball{i}"), [x, 0.0]).with_velocity([speed, 0.0]))
        })
        .collect();
    for (name, pair) in ["first", "second"].iter().zip(balls.windows(2)) {
        builder.constraint(*name, Limits { restitution: 1.0, ..Limits::between(pair[0], pair[1], 0.1, 10.0) });
    }
    start(builder)
}

/// Balls that touch share the blow, and a warning says so once; balls with a gap pass it on.
#[test]
fn a_blow_that_is_shared_is_told() {
    let shared = |reports: &[StepReport]| -> Vec<String> {
        let warnings = reports.iter().flat_map(|report| &report.warnings);
        warnings.filter(|it| matches!(it, qhat::Warning::SharedImpact { .. })).map(ToString::to_string).collect()
    };
    let mut simulation = row_of_balls(0.0);
    let told = shared(&run(&mut simulation, 0.5));
    assert_eq!(told.len(), 1);
    assert!(told[0].starts_with("`first` and `second` were struck at once at t = 0.1 s"), "{}", told[0]);
    // One ball against two: momentum and energy are those of masses of 1 and 2.
    let v: Vec<f64> = simulation.state().velocities().iter().step_by(2).copied().collect();
    assert!(
        [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0].iter().zip(&v).all(|(expected, v)| (v - expected).abs() < 1e-12),
        "{v:?}"
    );
    let mut simulation = row_of_balls(1e-6);
    assert_eq!(shared(&run(&mut simulation, 0.5)), [""; 0]);
    let v: Vec<f64> = simulation.state().velocities().iter().step_by(2).copied().collect();
    assert!([0.0, 0.0, 1.0].iter().zip(&v).all(|(expected, v)| (v - expected).abs() < 1e-12), "{v:?}");
}
