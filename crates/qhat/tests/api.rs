//! Questions of a program to a simulation between steps: by id and by name.

use crate::systems;
use qhat::{
    Angle, Constraint, Dimension, Distance, Driven, Force, ForceError, Gravity, Integrator, Limits, Nail, Obstacle,
    Particle, PointForce, Rope, Settings, Simulation, Spring, Strut, Surface, System, Vector,
};

const G: f64 = 10.0;

fn gravity() -> Gravity {
    Gravity::new([0.0, -G])
}

fn assert_close(is: &[f64], expected: &[f64]) {
    assert_eq!(is.len(), expected.len());
    for (is, expected) in is.iter().zip(expected) {
        // A handful of operations on numbers near 100.
        assert!((is - expected).abs() < 1e-11, "{is} is not {expected}");
    }
}

/// A load of 3 kg on a rod of 2 m, straight down, and a second rope that is slack.
fn hanging() -> Simulation {
    let mut builder = System::builder(Dimension::Two);
    let hook = builder.particle(Particle::at("hook", [1.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [1.0, -2.0]).with_mass(3.0));
    builder.constraint("rod", Distance::new(hook, load, 2.0));
    builder.constraint("rope", Rope::new(hook, load, 5.0));
    builder.named_force("gravity", gravity());
    let (system, state) = builder.build().unwrap();
    Simulation::new(system, state, Settings::default()).unwrap()
}

#[test]
fn names_find_ids_and_ids_find_places() {
    let simulation = hanging();
    let system = simulation.system();
    let load = system.particle("load").unwrap();
    assert_eq!((load.index(), system.particle_at(1), system.particle_at(2)), (1, Some(load), None));
    assert_eq!(system.particles().collect::<Vec<_>>(), [system.particle("hook").unwrap(), load]);
    let rope = system.constraint("rope").unwrap();
    assert_eq!((rope.index(), system.constraint_at(1), system.constraint_at(2)), (1, Some(rope), None));
    assert_eq!(system.constraint_of(rope).name, "rope");
    assert_eq!((system.force("gravity"), system.force_at(1)), (system.force_at(0), None));
    assert_eq!((system.particle("rod"), system.constraint("load"), system.force("rope")), (None, None, None));
    assert_eq!(simulation.position(load), [1.0, -2.0, 0.0]);
    assert_eq!(simulation.velocity(load), [0.0; 3]);
}

#[test]
fn what_hangs_pulls_its_rod_and_the_ground_down() {
    let mut simulation = hanging();
    let find = |name| simulation.system().constraint(name).unwrap();
    let (rod, rope) = (find("rod"), find("rope"));
    let [hook, load] = ["hook", "load"].map(|name| simulation.system().particle(name).unwrap());
    assert_close(&[simulation.tension_of(rod).unwrap()], &[30.0]);
    assert_close(&simulation.reaction(rod), &[-30.0]);
    assert_eq!(simulation.reaction(rope), [0.0]);
    assert_eq!(simulation.tension_of(rope), Some(0.0));
    assert_close(&simulation.support(hook), &[0.0, -30.0, 0.0]);
    assert_eq!(simulation.support(load), [0.0; 3]);
    let links: Vec<_> = simulation.links().map(|(link, tension)| (link.name.to_owned(), tension.round())).collect();
    assert_eq!(links, [("rod".to_owned(), 30.0), ("rope".to_owned(), 0.0)]);
}

/// The ground bears springs that end on it, and not the weight of the fixed particle itself.
#[test]
fn a_support_bears_springs() {
    let mut builder = System::builder(Dimension::Three);
    let wall = builder.particle(Particle::at("wall", [0.0; 3]).with_mass(1000.0).fixed());
    let bead = builder.particle(Particle::at("bead", [2.0, 0.0, 0.0]));
    builder.force(Spring { a: wall, b: bead, stiffness: 7.0, damping: 0.0, rest: 0.5 });
    builder.force(Gravity::new([0.0, 0.0, -G]));
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    assert_close(&simulation.support(wall), &[7.0 * 1.5, 0.0, 0.0]);
}

/// A nail pushes up with the weight, a motor holds its arm level, the ground pushes along its normal.
#[test]
fn reactions_have_the_signs_that_are_written() {
    let mut builder = System::builder(Dimension::Two);
    let mut add = |name: &str, x: f64, mass: f64| builder.particle(Particle::at(name, [x, 0.0]).with_mass(mass));
    let (a, b, c, d) = (add("a", 0.0, 1.0), add("b", 1.5, 2.0), add("c", 5.0, 4.0), add("d", 9.0, 3.0));
    let nail = builder.constraint("nail", Nail::new(a, [0.0, 0.0]));
    builder.constraint("arm", Distance::new(a, b, 1.5));
    let motor = builder.constraint("motor", Angle::from_direction([1.0, 0.0, 0.0], [a, b], 0.0));
    let ground = builder.constraint("ground", Obstacle::new(c, Surface::half_space([0.0, 1.0], 0.0)));
    let strut = builder.constraint("strut", Strut::new(c, d, 4.0));
    builder.constraint("stop", Obstacle::new(d, Surface::half_space([0.0, 1.0], 0.0)));
    builder.with_force(gravity()).force(PointForce::new(d, [-6.0, 0.0]));
    builder.constraint("wall", Obstacle::new(c, Surface::half_space([1.0, 0.0], 5.0)));
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    // Nail: both weights, one of them through the motor, whose torque is m g l. The arm itself pulls nothing.
    assert_close(&simulation.reaction(motor), &[2.0 * G * 1.5]);
    assert_close(&simulation.reaction(nail), &[0.0, 3.0 * G]);
    assert_close(&simulation.reaction(ground), &[4.0 * G]);
    // d is pushed against c, which the wall stops: a strut under thrust has a negative tension.
    assert_close(&simulation.reaction(strut), &[6.0]);
    assert_close(&[simulation.tension_of(strut).unwrap()], &[-6.0]);
    assert_eq!(simulation.tension_of(nail), None);
}

#[test]
fn the_nearest_particle_is_within_reach_or_none() {
    let simulation = hanging();
    let load = simulation.system().particle("load");
    assert_eq!(simulation.nearest([1.2, -1.9], 0.5), load);
    assert_eq!(simulation.nearest([1.2, -1.9, 7.0], 0.5), load, "z plays no part in the plane");
    assert_eq!(simulation.nearest([1.2, -1.9], 0.2), None);
}

#[test]
fn a_force_changes_by_its_id_and_its_jump_is_booked() {
    let mut simulation = hanging();
    let id = simulation.system().force("gravity").unwrap();
    simulation.step().unwrap();
    simulation.set_force(id, Gravity::new([3.0, -4.0])).unwrap();
    assert_eq!(simulation.gravity(), [3.0, -4.0, 0.0]);
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    // The pendulum swings towards its new vertical; dop853 at its default keeps the account to a millionth.
    assert!(simulation.energy().kinetic > 0.1 && simulation.energy_error().abs() < 1e-6);
    let load = simulation.system().particle("load").unwrap();
    simulation.set_force(id, PointForce::new(load, [0.0, -60.0])).unwrap();
    assert_eq!(simulation.gravity(), [0.0; 3]);
    let refused = simulation.set_force(id, PointForce::new(systems::id(2), [0.0, 1.0]));
    assert_eq!(refused, Err(ForceError::NoParticle { particle: 2 }));
    let mut other = System::builder(Dimension::Two);
    let beyond = [0, 1].map(|_| other.force(gravity()))[1];
    assert_eq!(simulation.set_force(beyond, gravity()), Err(ForceError::NoForce { force: 1 }));
}

/// Implicit methods lay out their matrix by the pairs that forces couple: another pair is another matrix.
#[test]
fn a_force_between_other_particles_is_followed_by_implicit_methods() {
    let mut builder = System::builder(Dimension::Two);
    let p = [0.0, 1.0, 2.0].map(|x| builder.particle(Particle::at(format!("p{x}"), [x, 0.0])));
    let spring = |a: usize, b: usize| Spring { a: p[a], b: p[b], stiffness: 50.0, damping: 1.0, rest: 0.8 };
    let id = builder.force(spring(0, 1));
    let (system, state) = builder.build().unwrap();
    let settings = Settings { integrator: Integrator::Implicit, ..Settings::default() };
    let mut changed = Simulation::new(system, state, settings).unwrap();
    changed.step().unwrap();
    changed.set_force(id, spring(1, 2)).unwrap();
    let fresh = Simulation::new(changed.system().clone(), changed.state().clone(), settings);
    let mut fresh = fresh.unwrap();
    for _ in 0..3 {
        changed.step().unwrap();
        fresh.step().unwrap();
    }
    assert_eq!(changed.state().positions(), fresh.state().positions());
}

/// The hand is no force of the builder: it moves no id.
#[test]
fn the_hand_leaves_the_forces_of_the_builder_alone() {
    let mut builder = System::builder(Dimension::Two);
    let a = builder.particle(Particle::at("a", [0.0, 0.0]));
    let own = qhat::MouseSpring { particle: a, target: [1.0, 0.0, 0.0], stiffness: 2.0, damping: 0.0 };
    builder.with_force(own).named_force("gravity", gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    simulation.grab(a, [5.0, 5.0]).unwrap();
    simulation.release();
    simulation.reset().unwrap();
    let kinds: Vec<_> = simulation.system().forces().iter().map(Force::kind).collect();
    assert_eq!(kinds, ["MouseSpring", "Gravity"]);
}

#[test]
fn driven_rods_and_nails_stand_under_their_own_names() {
    let mut builder = System::builder(Dimension::Two);
    let wall = builder.particle(Particle::at("wall", [0.0, 0.0]).fixed());
    let load = builder.particle(Particle::at("load", [0.0, -2.0]).with_mass(3.0));
    let hand = builder.particle(Particle::at("hand", [5.0, 0.0]));
    let winch = builder.constraint("winch", Distance::driven(load, wall, Driven::text("2 - t/10").unwrap()));
    let point = [Driven::try_from("5 + sin(t)").unwrap(), 0.0.into(), 0.0.into()];
    builder.constraint("hand", Nail::driven(hand, point));
    builder.force(gravity());
    let (system, state) = builder.build().unwrap();
    let kinds: Vec<_> = system.constraints().iter().map(|named| named.constraint.kind()).collect();
    assert_eq!(kinds, ["OnSphere", "Relation"]);
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    // The winch winds at a constant speed: its tension, minus the multiplier, is the weight.
    assert_close(&simulation.reaction(winch), &[-30.0]);
    for _ in 0..100 {
        simulation.step().unwrap();
    }
    assert!((simulation.position(load)[1] + 1.9).abs() < 1e-9);
    assert!((simulation.position(hand)[0] - 5.0 - libm::sin(simulation.state().time())).abs() < 1e-9);
    let error = Driven::text("2*pi*x").unwrap_err();
    assert_eq!(&"2*pi*x"[error.span.clone()], "x");
}

#[test]
fn an_expression_of_the_builder_knows_its_particles() {
    let mut builder = System::builder(Dimension::Two);
    builder.with_particle(Particle::at("bead", [1.0, 0.0]));
    let circle = builder.expression(qhat::Purpose::Constraint, "bead.x^2 + bead.y^2 - 1").unwrap();
    assert_eq!(circle.particles(), [builder.particle_at(0).unwrap()]);
    assert!(builder.expression(qhat::Purpose::Constraint, "bob.x").is_err());
}

#[test]
fn a_builder_chains_to_its_end_and_builds_again() {
    let mut builder = System::builder(Dimension::Two);
    let first = builder.with_particle(Particle::at("a", [0.0, 0.0])).with_force(gravity()).build().unwrap().0;
    let second = builder.with_particle(Particle::at("b", [1.0, 0.0])).build().unwrap().0;
    assert_eq!((first.particle_count(), second.particle_count(), second.forces().len()), (1, 2, 1));
}

#[test]
fn two_components_are_three_with_z_zero() {
    assert_eq!(Vector::from([1.0, 2.0]), Vector::from([1.0, 2.0, 0.0]));
    assert_eq!(Gravity::new([0.0, -1.0]), Gravity { acceleration: [0.0, -1.0, 0.0] });
    let (a, b) = (systems::id(0), systems::id(1));
    assert_eq!(Nail::new(a, [1.0, 2.0]), Nail::new(a, [1.0, 2.0, 0.0]));
    assert_eq!(Rope::new(a, b, 2.0), Limits::rope(a, b, 2.0));
    assert_eq!(Surface::ball([1.0, 2.0], 3.0), Surface::Ball { center: [1.0, 2.0, 0.0], radius: 3.0, inside: false });
}

#[test]
fn every_kind_has_its_name() {
    let (a, b) = (systems::id(0), systems::id(1));
    assert_eq!(Constraint::from(Distance::new(a, b, 1.0)).kind(), "Distance");
    assert_eq!(Force::from(gravity()).kind(), "Gravity");
    assert!(Constraint::KINDS.contains(&"OnCurve") && Force::KINDS.contains(&"Gas"));
}

#[test]
fn backward_euler_goes_by_both_of_its_names() {
    assert_eq!("backward-euler".parse(), Ok(Integrator::Implicit));
    assert_eq!(Integrator::Implicit.to_string(), "implicit");
}

/// A pendulum from the horizontal pulls most where it is lowest, with 3 m g; the frame that holds this moment says so,
/// and whether anything is recorded changes nothing.
#[test]
fn the_largest_tension_within_a_frame_is_recorded() {
    let start = || {
        let (system, state) = systems::pendulum(std::f64::consts::FRAC_PI_2);
        // A frame in which it falls and rises again.
        let settings = Settings { tolerance: 1e-12, ..systems::settings(Integrator::Dop853, 1.2) };
        Simulation::new(system, state, settings).unwrap()
    };
    let (mut watched, mut alone) = (start(), start());
    watched.record_tension(true);
    let report = watched.step().unwrap();
    assert_eq!(alone.step().unwrap().max_tension, None);
    assert_eq!(watched.state(), alone.state());
    let largest = report.max_tension.unwrap();
    assert_eq!(watched.system().constraint_of(largest.link).name, "rod");
    let highest = 3.0 * 2.0 * systems::G;
    // At this tolerance substeps are at most 0.1 s long: the one nearest to the lowest point is within 0.05 s of it,
    // where m g (3 cos φ) has lost 3 % at a speed of 4.4 rad/s.
    assert!(largest.tension <= highest + 1e-6 && largest.tension > 0.95 * highest, "{largest:?}");
    // A quarter of the period of the full swing, 1.18 times that of small ones.
    assert!((largest.time - 0.25 * 1.18034 * 2.0 * std::f64::consts::PI / systems::G.sqrt()).abs() < 0.06);
    assert!(largest.tension > 1.5 * watched.tension()[0].abs());
    watched.record_tension(false);
    assert_eq!(watched.step().unwrap().max_tension, None);
}

/// Every integrator records, chains and contacts alike.
#[test]
fn every_integrator_records_tensions() {
    for integrator in Integrator::ALL {
        let (system, state) = systems::pendulum(0.0);
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, 1e-3)).unwrap();
        simulation.record_tension(true);
        let largest = simulation.advance(5e-3).unwrap().max_tension.unwrap();
        assert!((largest.tension - 2.0 * systems::G).abs() < 1e-6, "{integrator}: {largest:?}");
    }
    let mut simulation = hanging();
    simulation.record_tension(true);
    let largest = simulation.step().unwrap().max_tension.unwrap();
    assert_eq!(simulation.system().constraint_of(largest.link).name, "rod");
    assert!((largest.tension - 30.0).abs() < 1e-9);
}

/// A jerk that no substep of DOP853 can follow ends its part of the frame in an error, and BDF2 finishes the frame. The
/// report has the largest tension all the same.
#[test]
fn a_frame_that_auto_hands_over_after_an_error_is_recorded() {
    let mut builder = System::builder(Dimension::Two);
    let hand = builder.particle(Particle::at("hand", [0.0, 0.0]));
    let bob = builder.particle(Particle::at("bob", [0.0, -1.0]));
    // Within 1e-15 s, shorter than any substep, the hand jumps by 0.3 m.
    let jump = Driven::text("0.1*atan(1e15*(t - 0.005)) + 0.05*pi").unwrap();
    builder.constraint("hand", Nail::driven(hand, [jump, 0.0.into(), 0.0.into()]));
    builder.with_constraint("rod", Distance::new(hand, bob, 1.0)).force(gravity());
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, Settings::default()).unwrap();
    simulation.record_tension(true);
    let report = simulation.step().unwrap();
    assert_eq!(report.integrator, Integrator::Bdf2);
    let largest = report.max_tension.unwrap();
    assert_eq!(simulation.system().constraint_of(largest.link).name, "rod");
}
