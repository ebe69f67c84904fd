//! The measured order of every integrator is its declared order ± 0.1 on constrained motion with forces in q and in q̇:
//! in position, velocity and multipliers, and in the account of energy.

use crate::systems;
use crate::systems::dense::difference;
use qhat::{
    Dimension, Distance, Drag, Integrator, Particle, Settings, Simulation, Spring, State, System, Workspace, evaluate,
    step,
};

/// A double pendulum of unequal masses with drag and a damped spring: forces in q and in q̇, and a constraint force
/// that matters, so that a method which misses the velocity by its impulse falls to order 1.
fn system() -> (System, State) {
    let mut builder = System::builder(Dimension::Two);
    let pivot = builder.particle(Particle::at("pivot", [0.0, 0.0]).fixed());
    let elbow = builder.particle(Particle::at("elbow", [0.8, -0.6]).with_velocity([0.6, 0.8]));
    let tip = builder.particle(Particle::at("tip", [1.6, -1.2]).with_mass(0.4).with_velocity([1.2, 1.6]));
    let anchor = builder.particle(Particle::at("anchor", [1.0, 1.0]).fixed());
    builder
        .with_constraint("upper", Distance::new(pivot, elbow, 1.0))
        .constraint("lower", Distance::new(elbow, tip, 1.0));
    builder.with_force(systems::gravity()).force(Drag { coefficient: 0.3 });
    builder.force(Spring { a: tip, b: anchor, stiffness: 4.0, damping: 0.5, rest: 0.5 });
    builder.build().unwrap()
}

const DURATION: f64 = 0.5;

/// q, q̇, λ and the work booked after `steps` equal steps.
fn run(integrator: Integrator, steps: usize) -> [Vec<f64>; 4] {
    let (system, mut state) = system();
    // With these settings RATTLE takes each frame in one substep: an error of almost 1 is allowed, and h is below the
    // bounds from stability and from the rotation of the rods. The report is checked for it. Newton iterates to
    // roundoff, far below the measured error.
    let settings = Settings {
        integrator,
        h: DURATION / steps as f64,
        tolerance: 0.999,
        constraint_tolerance: 1e-14,
        ..Settings::default()
    };
    let mut workspace = Workspace::new(&system);
    for _ in 0..steps {
        let report = step(&system, &mut state, &settings, &mut workspace).unwrap();
        assert_eq!((report.substeps, report.rejected), (1, 0), "{integrator} must keep its substep constant");
    }
    let terms = evaluate(&system, &state);
    [state.positions().to_vec(), state.velocities().to_vec(), terms.multipliers, vec![state.work().dissipation]]
}

/// log₂ of the ratio of errors of two runs, one with twice the steps of the other.
fn observed(coarse: f64, fine: f64) -> f64 {
    libm::log2(coarse / fine)
}

/// `allowed` is the deviation of the observed order that the next terms of the error expansion may cause at these h.
fn check(integrator: Integrator, steps: &[usize], allowed: f64) {
    // RK4 with 4e4 steps is exact to roundoff (h⁴ = 2e-20 in units of the motion's own time).
    let exact = run(Integrator::Rk4, 40_000);
    let runs: Vec<_> = steps.iter().map(|&steps| run(integrator, steps)).collect();
    for (k, what) in ["positions", "velocities", "multipliers", "dissipation"].into_iter().enumerate() {
        let errors: Vec<f64> = runs.iter().map(|run| difference(&run[k], &exact[k])).collect();
        for pair in errors.windows(2) {
            let order = observed(pair[0], pair[1]);
            let declared = f64::from(integrator.order());
            assert!((order - declared).abs() < allowed, "{integrator}: {what} of order {order}, errors {errors:?}");
        }
    }
}

#[test]
fn euler_is_of_order_one() {
    check(Integrator::Euler, &[2000, 4000, 8000], 0.1);
}

#[test]
fn symplectic_euler_is_of_order_one() {
    check(Integrator::SymplecticEuler, &[2000, 4000, 8000], 0.1);
}

#[test]
fn rk4_is_of_order_four() {
    check(Integrator::Rk4, &[120, 240, 480], 0.1);
}

#[test]
fn dopri5_is_of_order_five() {
    // The pair was chosen for its small leading error. The next term is therefore still visible at errors at which
    // roundoff (1e-14) is visible, too.
    check(Integrator::Dopri5, &[50, 100], 0.45);
}

#[test]
fn dop853_is_of_order_eight() {
    // Between errors too large for the leading term and errors of roundoff (1e-15) lie only two doublings of order
    // eight.
    check(Integrator::Dop853, &[5, 10, 20], 0.8);
}

#[test]
fn radau5_is_of_order_five() {
    // Between steps that are too long for one substep and the 1e-10 to which the stages are solved.
    check(Integrator::Radau5, &[10, 20], 0.1);
}

#[test]
fn rattle_is_of_order_two() {
    check(Integrator::Rattle, &[200, 400, 800], 0.1);
}

#[test]
fn implicit_is_of_order_one() {
    check(Integrator::Implicit, &[2000, 4000, 8000], 0.1);
}

#[test]
fn bdf2_is_of_order_two() {
    check(Integrator::Bdf2, &[400, 800, 1600], 0.1);
}

/// With substeps of its own choice, RATTLE's error falls with the ⅔ power of the tolerance: the substep is proportional
/// to the cube root of the tolerance, and the error to the square of the substep. Substeps are chosen from an estimate,
/// so the power is not exact.
#[test]
fn long_rattle_follows_its_tolerance() {
    let error = |tolerance: f64| {
        let (system, state) = system();
        let integrator = Integrator::Rattle;
        let settings = Settings { h: 0.05, integrator, tolerance, constraint_tolerance: 1e-14, ..Settings::default() };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        difference(simulation.state().positions(), &run(Integrator::Rk4, 40_000)[0])
    };
    let errors = [1e-4, 1e-6, 1e-8].map(error);
    for pair in errors.windows(2) {
        let power = libm::log10(pair[0] / pair[1]) / 2.0;
        assert!((power - 2.0 / 3.0).abs() < 0.15, "power {power}, errors {errors:?}");
    }
}

/// RATTLE is symmetric: a run forwards, then with reversed velocities, ends at the start. This holds only without drag.
#[test]
fn rattle_is_reversible() {
    let (system, start) = systems::double_pendulum();
    let settings = Settings {
        integrator: Integrator::Rattle,
        h: 1e-3,
        tolerance: 0.999,
        constraint_tolerance: 1e-14,
        ..Settings::default()
    };
    let mut workspace = Workspace::new(&system);
    let mut state = start.clone();
    for _ in 0..2 {
        for _ in 0..500 {
            let report = step(&system, &mut state, &settings, &mut workspace).unwrap();
            assert_eq!(report.substeps, 1);
        }
        let turned = state.velocities().iter().map(|v| -v).collect();
        state = state.with_motion(state.positions().to_vec(), turned);
    }
    // Roundoff of 1000 steps, multiplied by the sensitivity of the motion (about 1e2 in a second).
    let error = difference(state.positions(), start.positions());
    assert!(error < 1e-10, "off by {error:e}; the method's own error at this h is some 1e-5");
}
