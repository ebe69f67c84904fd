//! Energy that comes or goes without a cause is told, and so is energy that cannot be computed.

use crate::systems::{self, FRAME};
use qhat::{
    AirDrag, Dimension, Distance, Drag, ExpressionForce, Integrator, Obstacle, Particle, Purpose, Settings, Simulation,
    Spring, StepError, Surface, System, SystemBuilder, Warning,
};

/// Runs so many frames and gives the warnings of energy: the change [J], its share, and the integrator.
fn told(simulation: &mut Simulation, frames: usize) -> Vec<(f64, f64, Integrator)> {
    for _ in 0..frames {
        simulation.step().unwrap();
    }
    let entries = simulation.warnings().entries().iter();
    entries
        .filter_map(|entry| match entry.warning {
            Warning::EnergyUnaccounted { energy, relative, integrator, .. } => Some((energy, relative, integrator)),
            _ => None,
        })
        .collect()
}

/// A chain that cracks like a whip loses most of its energy under methods that solve at the end of the step.
#[test]
fn a_damped_whip_is_told() {
    for integrator in [Integrator::Bdf2, Integrator::Implicit] {
        let (system, state) = systems::chain(20, 1.0);
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, FRAME)).unwrap();
        let told = told(&mut simulation, 120);
        // Bdf2 also gives a little back.
        let Some(&(energy, relative, by)) = told.first() else { panic!("{integrator}: nothing is told") };
        assert!(energy < 0.0 && relative < -0.01 && by == integrator, "{told:?}");
        let entry = &simulation.warnings().entries()[0];
        assert!(entry.frames > 1 && entry.first < entry.last, "{entry:?}");
        let words = entry.to_string();
        assert!(words.contains(" J, ") && words.contains("a smaller h damps less"), "{words}");
        assert!(words.contains(&format!("({} frames, from t = ", entry.frames)), "{words}");
    }
}

/// The warning has the energy of one step and its time, in the report of that step.
#[test]
fn the_report_of_a_step_tells_its_energy() {
    let (system, state) = systems::chain(20, 1.0);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Bdf2, FRAME)).unwrap();
    let (mut largest, mut told) = (0.0_f64, 0);
    let mut before = simulation.energy().balance();
    for _ in 0..120 {
        let report = simulation.step().unwrap();
        let balance = report.energy.balance();
        largest = largest.max(report.energy.kinetic);
        for warning in &report.warnings {
            let Warning::EnergyUnaccounted { time, energy, relative, .. } = *warning else { panic!("{warning}") };
            // A change from rest may be told some steps later.
            if time == simulation.state().time() {
                // Both are differences of energies below a joule: a few roundings.
                assert!((energy - (balance - before)).abs() < 1e-12, "{energy} J");
                assert_eq!(relative, energy / largest);
                told += 1;
            }
        }
        before = balance;
    }
    assert!(told > 0);
}

/// Euler's method blows an oscillation up in plain sight, by h²ω² = 9 % of its energy a step: with a warning, and not
/// with an error.
#[test]
fn an_oscillation_that_blows_up_is_told() {
    let mut builder = System::builder(Dimension::Two);
    let wall = builder.particle(Particle::at("wall", [0.0, 0.0]).fixed());
    let bead = builder.particle(Particle::at("bead", [1.5, 0.0]));
    builder.force(Spring { a: wall, b: bead, stiffness: 100.0, damping: 0.0, rest: 1.0 });
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Euler, 0.03)).unwrap();
    let told = told(&mut simulation, 60);
    assert!(told.iter().any(|&(energy, relative, _)| energy > 0.0 && relative > 0.1), "{told:?}");
}

fn ball(builder: &mut SystemBuilder, restitution: f64) {
    let ball = builder.particle(Particle::at("ball", [0.0, 1.0]).with_velocity([1.0, 0.0]));
    let floor = Surface::half_space([0.0, 1.0], 0.0);
    builder.constraint("floor", Obstacle::new(ball, floor).with_restitution(restitution));
    builder.force(systems::gravity());
}

/// Drag, impacts, drives and a hand take and give energy, and the account knows them: nothing is told. Nor are the
/// first steps from rest under Euler's methods, whose errors are all of the kinetic energy there is by then.
#[test]
fn energy_with_a_cause_is_not_told() {
    let quiet = |name: &str, builder: SystemBuilder, settings: Settings, frames: usize| {
        let (system, state) = builder.build().unwrap();
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        assert_eq!(told(&mut simulation, frames), [], "{name}");
        simulation
    };
    let builder = || System::builder(Dimension::Two);

    let mut dragged = builder();
    let stone = dragged.particle(Particle::at("stone", [0.0, 0.0]).with_velocity([30.0, 0.0]));
    dragged.with_force(Drag { coefficient: 2.0 }).force(AirDrag::still(stone, 0.1, 0.2));
    quiet("drag", dragged, systems::settings(Integrator::Auto, FRAME), 120);

    let mut bouncing = builder();
    ball(&mut bouncing, 0.5);
    quiet("impacts", bouncing, systems::settings(Integrator::Auto, FRAME), 240);

    for integrator in [Integrator::Euler, Integrator::SymplecticEuler, Integrator::Implicit, Integrator::Bdf2] {
        let mut falling = builder();
        falling.with_particle(Particle::at("stone", [0.0, 0.0])).force(systems::gravity());
        quiet(integrator.name(), falling, systems::settings(integrator, 0.01), 100);
    }

    let (system, state) = systems::pendulum(1.0);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, FRAME)).unwrap();
    let bob = simulation.system().particle_at(1).unwrap();
    simulation.grab(bob, [1.0, 1.0]).unwrap();
    assert_eq!(told(&mut simulation, 30), [], "a hand");
    simulation.release();
    simulation.set_gravity([0.0, -20.0]).unwrap();
    assert_eq!(told(&mut simulation, 60), [], "gravity that changes");
}

/// Every method ends where the motion is no longer finite, and names the particle that runs away.
#[test]
fn what_is_not_finite_ends_the_run() {
    for integrator in Integrator::ALL {
        let mut builder = System::builder(Dimension::Two);
        let a = builder.particle(Particle::at("a", [0.0, 0.0]));
        let b = builder.particle(Particle::at("b", [0.0, 1.0]));
        let wild = builder.particle(Particle::at("wild", [1.0, 1.0]).with_velocity([1.0, 0.0]));
        builder.with_constraint("rod", Distance::new(a, b, 1.0));
        let components = ["wild.x^3", "0"].map(|text| builder.expression(Purpose::Force, text).unwrap()).to_vec();
        builder.force(ExpressionForce { particle: wild, components });
        let (system, state) = builder.build().unwrap();
        // x(t) is infinite at t = ∫₁^∞ dx/√(x⁴/2 + 1/2) = 1.31 s; methods of low order come late.
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, 0.01)).unwrap();
        let error = (0..1000).find_map(|_| simulation.step().err());
        let error = error.unwrap_or_else(|| panic!("{integrator} went on to t = {} s", simulation.state().time()));
        let (time, particle) = match &error {
            StepError::NotFinite { time, particle } | StepError::RanAway { time, particle, .. } => (time, particle),
            other => panic!("{integrator}: {other}"),
        };
        assert_eq!(particle, "wild", "{integrator}: {error}");
        assert!((1.2..2.0).contains(time), "{integrator}: {error}");
        assert!(simulation.state().positions().iter().all(|x| x.is_finite()), "{integrator}: the last good state");
    }
}

/// A start whose energy is not finite is refused, with the particle's name; a maximum over NaN would have said 0.
#[test]
fn a_start_without_a_finite_energy_is_refused() {
    let start = |x: f64, v: f64| {
        let mut builder = System::builder(Dimension::Two);
        builder.with_particle(Particle::at("light", [-10.0, x]).with_velocity([v, 0.0]));
        builder.with_particle(Particle::at("heavy", [0.0, 0.0]).with_mass(4.0)).force(systems::gravity());
        builder.build().unwrap()
    };
    for integrator in Integrator::ALL {
        for (x, v, which) in [(1e308, 0.0, "potential"), (0.0, 1e200, "kinetic")] {
            let (system, state) = start(x, v);
            let error = Simulation::new(system, state, systems::settings(integrator, 0.01)).unwrap_err();
            let StepError::EnergyNotFinite { time, energy, particle } = error else { panic!("{integrator}: {error}") };
            assert_eq!((time, energy, particle.as_str()), (0.0, which, "light"), "{integrator}");
        }
    }
}

/// Where roundoff of large coordinates hides a step, methods that solve at its end say so: nothing would move.
#[test]
fn coordinates_that_hide_the_motion_are_refused() {
    let pendulum = |far: f64| {
        let mut builder = System::builder(Dimension::Two);
        let pivot = builder.particle(Particle::at("pivot", [far, 0.0]).fixed());
        let bob = builder.particle(Particle::at("bob", [far + 1.0, 0.0]));
        builder.with_constraint("rod", Distance::new(pivot, bob, 1.0)).force(systems::gravity());
        builder.build().unwrap()
    };
    for integrator in [Integrator::Implicit, Integrator::Bdf2] {
        for (far, h) in [(1e12, 0.01), (1e10, 0.01), (1e6, 1e-5)] {
            let (system, state) = pendulum(far);
            let mut simulation = Simulation::new(system, state, systems::settings(integrator, h)).unwrap();
            let error = simulation.step().unwrap_err();
            assert!(matches!(&error, StepError::TooFarOut { particle, .. } if particle == "bob"), "{error}");
        }
        // Not so far out it falls: y = −½ g t² within the method's error and the rod's turn.
        let (system, state) = pendulum(1e6);
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, 0.01)).unwrap();
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        let y = simulation.state().positions()[3];
        assert!((y + 0.5 * systems::G * 0.01).abs() < 0.01, "{integrator}: {y}");
    }
}
