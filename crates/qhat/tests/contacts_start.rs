//! Starts of systems with contacts: the nearest positions and velocities that satisfy equations and contacts.

use crate::systems::random::Random;
use crate::systems::settings;
use qhat::{
    Dimension, Distance, EventKind, Integrator, Limits, Obstacle, Particle, Settings, Simulation, State, StepError,
    Surface, System, SystemBuilder,
};

fn start(builder: SystemBuilder) -> Result<Simulation, StepError> {
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, Settings { tolerance: 1e-8, ..settings(Integrator::Auto, 0.01) })
}

fn ground() -> Surface {
    Surface::half_space([0.0, 1.0], 0.0)
}

fn gravity() -> qhat::Gravity {
    qhat::Gravity { acceleration: [0.0, -10.0, 0.0] }
}

/// A bar from a hook 1 m above the ground, with its foot on the ground 1 m beside it. A longer bar would push the foot
/// into the ground; it slides along it instead, and stays there.
#[test]
fn a_foot_on_the_ground_is_not_pushed_into_it() {
    for length in [1.5, 1.415213562373095, 1.4142135724, 2.5] {
        for friction in [0.0, 0.5] {
            let mut builder = System::builder(Dimension::Two);
            let hook = builder.particle(Particle::at("hook", [0.0, 1.0]).fixed());
            let foot = builder.particle(Particle::at("foot", [1.0, 0.0]));
            builder
                .with_constraint("bar", Distance::new(hook, foot, length))
                .with_constraint("ground", Obstacle::new(foot, ground()).with_friction(friction))
                .force(gravity());
            let mut simulation = start(builder).unwrap();
            let expected = (length * length - 1.0_f64).sqrt();
            let place = simulation.state().positions()[2..4].to_vec();
            assert!((place[0] - expected).abs() < 1e-9 && place[1].abs() < 1e-9, "{length}: {place:?}");
            assert!((simulation.projection().moved - (expected - 1.0)).abs() < 1e-9);
            for _ in 0..30 {
                simulation.step().unwrap();
            }
            let after = &simulation.state().positions()[2..4];
            assert!((after[0] - place[0]).abs() < 1e-9 && after[1].abs() < 1e-9, "{length}: {after:?}");
            // What a length may be off by, times the weight.
            assert!(simulation.energy_error().abs() < 1e-7, "{length}: {}", simulation.energy_error());
        }
    }
}

/// The nearest of the points on a circle of radius r about the origin that lie above y = a and left of x = b.
fn nearest_on_circle(from: [f64; 2], r: f64, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
    let size = (from[0] * from[0] + from[1] * from[1]).sqrt();
    let (x, y) = ((r * r - a * a).sqrt(), (r * r - b * b).sqrt());
    let candidates = [[from[0] * r / size, from[1] * r / size], [x, a], [-x, a], [b, y], [b, -y]];
    let allowed = candidates.into_iter().filter(|p| p[0] <= b + 1e-12 && p[1] >= a - 1e-12);
    let way = |p: &[f64; 2]| (p[0] - from[0]) * (p[0] - from[0]) + (p[1] - from[1]) * (p[1] - from[1]);
    allowed.min_by(|p, q| way(p).total_cmp(&way(q)))
}

/// A bob whose rod does not fit, between a ground and a wall: the start is the nearest of all that satisfy both.
#[test]
fn a_start_is_the_nearest_that_satisfies_everything() {
    let mut moved_along = 0;
    for seed in 0..900 {
        let mut random = Random::new(seed);
        let (a, b, r) = (random.within(-1.0, 0.3), random.within(0.2, 1.2), random.within(0.8, 1.6));
        let from = [random.within(b - 1.0, b), random.within(a, a + 1.0)];
        let size = (from[0] * from[0] + from[1] * from[1]).sqrt();
        // Starts that are not farther off than half the length: from farther away there are several answers.
        if (size - r).abs() > 0.5 * r || size < 0.3 {
            continue;
        }
        let Some(expected) = nearest_on_circle(from, r, [a, b]) else { continue };
        let way = ((expected[0] - from[0]) * (expected[0] - from[0])
            + (expected[1] - from[1]) * (expected[1] - from[1]))
            .sqrt();
        if way > 0.4 * r {
            continue;
        }
        let mut builder = System::builder(Dimension::Two);
        let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", from).with_mass(random.within(0.1, 10.0)));
        builder
            .with_constraint("rod", Distance::new(hook, bob, r))
            .with_constraint("ground", Obstacle::new(bob, Surface::half_space([0.0, 1.0], a)).with_friction(0.3))
            .with_constraint("wall", Obstacle::new(bob, Surface::half_space([-1.0, 0.0], -b)))
            .force(gravity());
        let simulation = start(builder).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let place = &simulation.state().positions()[2..4];
        let off = (place[0] - expected[0]).abs().max((place[1] - expected[1]).abs());
        assert!(off < 1e-7, "seed {seed}: {place:?}, expected {expected:?} from {from:?}");
        moved_along += usize::from(place[1] < a + 1e-9 || place[0] > b - 1e-9);
    }
    assert!(moved_along > 30, "{moved_along}");
}

/// Two bobs on a rod that is too short for them, one of them on a taut rope: the light one moves more.
#[test]
fn ropes_take_part_in_the_nearest_start_by_their_masses() {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let one = builder.particle(Particle::at("one", [1.0, 0.0]).with_mass(3.0));
    let other = builder.particle(Particle::at("other", [2.0, 0.0]));
    builder
        .with_constraint("rope", Limits::rope(hook, one, 1.0))
        .with_constraint("rod", Distance::new(one, other, 1.2));
    let simulation = start(builder).unwrap();
    // Without the rope, `one` would go to 0.95; with it, it may: the rope only goes slack.
    assert!((simulation.state().positions()[2] - 0.95).abs() < 1e-9);
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let one = builder.particle(Particle::at("one", [1.0, 0.0]).with_mass(3.0));
    let other = builder.particle(Particle::at("other", [2.0, 0.0]));
    builder
        .with_constraint("rope", Limits::rope(hook, one, 1.0))
        .with_constraint("rod", Distance::new(one, other, 0.8));
    let simulation = start(builder).unwrap();
    // Without the rope, `one` would go to 1.05; the rope holds it, and `other` goes all the way.
    let q = simulation.state().positions();
    assert!((q[2] - 1.0).abs() < 1e-9 && (q[4] - 1.8).abs() < 1e-9, "{q:?}");
}

/// A foot on a bouncy ground whose velocity does not fit its bar: the bar must not throw it into the ground, for there
/// it would bounce. A velocity that is written into the ground is an impact of the first step.
#[test]
fn velocities_of_a_start_bring_no_impact_of_their_own() {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 1.0]).fixed());
    let foot = builder.particle(Particle::at("foot", [1.0, 0.0]).with_velocity([-1.0, 0.0]));
    builder
        .with_constraint("bar", Distance::new(hook, foot, 2.0_f64.sqrt()))
        .with_constraint("ground", Obstacle::new(foot, ground()).with_restitution(1.0))
        .force(gravity());
    let mut simulation = start(builder).unwrap();
    assert!(simulation.state().velocities()[2..4].iter().all(|v| v.abs() < 1e-15));
    let events = simulation.step().unwrap().events;
    assert!(!events.iter().any(|event| matches!(event.kind, EventKind::Impact { .. })), "{events:?}");

    let mut builder = System::builder(Dimension::Two);
    let ball = builder.particle(Particle::at("ball", [0.0, 0.0]).with_velocity([1.0, -2.0]));
    builder.with_constraint("ground", Obstacle::new(ball, ground()).with_restitution(0.5));
    let mut simulation = start(builder).unwrap();
    assert_eq!(simulation.state().velocities(), [1.0, -2.0]);
    let events = simulation.step().unwrap().events;
    assert_eq!(events[0].kind, EventKind::Impact { speed: 2.0 });
    assert_eq!(simulation.state().velocities(), [1.0, 1.0]);
}

/// A bar that cannot reach a wall it must not cross; the error names what is off.
#[test]
fn a_start_that_cannot_be_is_an_error_that_names_it() {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", [2.0, 0.0]));
    builder
        .with_constraint("bar", Distance::new(hook, bob, 1.0))
        .with_constraint("wall", Obstacle::new(bob, Surface::half_space([1.0, 0.0], 2.0)));
    match start(builder) {
        Err(StepError::NotSatisfied { row, residual, .. }) => {
            assert!(row == "bar" || row == "wall", "{row}");
            assert!(residual.abs() > 0.1, "{residual}");
        }
        other => panic!("{other:?}"),
    }
}

/// A start that satisfies everything does not move by a bit.
#[test]
fn a_start_that_fits_does_not_move() {
    let place: [f64; 2] = [0.6, -0.8];
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [0.0, 0.0]).fixed());
    let bob = builder.particle(Particle::at("bob", place).with_velocity([0.8, 0.6]));
    builder
        .with_constraint("rope", Limits::rope(hook, bob, 1.0))
        .with_constraint("ground", Obstacle::new(bob, Surface::half_space([0.0, 1.0], -0.8)));
    let simulation = start(builder).unwrap();
    let state: &State = simulation.state();
    assert_eq!((&state.positions()[2..4], &state.velocities()[2..4]), (&place[..], &[0.8, 0.6][..]));
    assert_eq!(simulation.projection().moved, 0.0);
}
