//! Conservation of energy and momentum, and the account of energy that enters and leaves.

use crate::systems;
use crate::systems::dense::assert_close;
use qhat::{Feedback, Gravity, Integrator, Settings, Simulation, State, System};

fn tight(tolerance: f64) -> Settings {
    Settings { tolerance, constraint_tolerance: 1e-13, ..systems::settings(Integrator::Rattle, 1.0 / 60.0) }
}

fn run(simulation: &mut Simulation, seconds: f64) {
    let frames = (seconds / simulation.settings().h).round() as usize;
    for _ in 0..frames {
        simulation.step().unwrap();
    }
}

#[test]
fn double_pendulum_keeps_its_energy() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, tight(1e-8)).unwrap();
    run(&mut simulation, 12.0);
    // Order 2: substeps shrink with the cube root of the tolerance, errors with its ⅔ power. 1e-4 leaves 6e-4, so 1e-8
    // must leave about 1e-6.
    assert!(simulation.energy_error_max() < 4e-6, "{:e}", simulation.energy_error_max());
    assert!(simulation.energy().kinetic > 0.1, "it still swings");
}

/// A chain of 100 links released from the horizontal cracks like a whip; a load of 1000 beads keeps it taut. A
/// tolerance of 1e-4 must be enough for both.
#[test]
fn long_whipping_chains_keep_length_and_energy_under_dop853() {
    for heavy in [1.0, 1000.0] {
        let (system, state) = systems::chain(100, heavy);
        let settings = Settings { tolerance: 1e-4, ..systems::settings(Integrator::Dop853, 1.0 / 60.0) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        let mut substeps = 0;
        for _ in 0..120 {
            let report = simulation.step().unwrap();
            assert!(report.max_relative_length_error <= settings.constraint_tolerance);
            substeps += report.substeps;
        }
        // Twice the tolerance of 1e-4: errors of substeps add up, but most of the error is made in the crack.
        assert!(simulation.energy_error_max() < 2e-4, "{heavy}: {:e}", simulation.energy_error_max());
        // Some 450 and 880, where RATTLE takes ten times more (`benches/results/workloads.csv`), because the order is
        // 8.
        assert!(substeps < 1000, "{heavy}: {substeps} substeps");
    }
}

#[test]
fn double_pendulum_keeps_its_energy_under_rk4() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rk4, 1e-3)).unwrap();
    run(&mut simulation, 10.0);
    // (hω)⁴ at the whip's 30 rad/s: 1e-6 a swing at worst.
    assert!(simulation.energy_error_max() < 1e-6, "{:e}", simulation.energy_error_max());
}

/// P = Σ m v and L = Σ x × m v.
fn momenta(system: &System, state: &State) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for (i, m) in system.masses().iter().enumerate() {
        let (x, v) = (&state.positions()[3 * i..], &state.velocities()[3 * i..]);
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            sum[k] += m * v[k];
            sum[3 + k] += m * (x[a] * v[b] - x[b] * v[a]);
        }
    }
    sum
}

#[test]
fn free_structure_keeps_momentum_and_energy() {
    for integrator in [Integrator::Rattle, Integrator::Rk4, Integrator::SymplecticEuler] {
        let (system, state) = systems::free_structure();
        let settings = if integrator.is_adaptive() { tight(1e-6) } else { systems::settings(integrator, 1e-3) };
        // The methods that do not project must start where Ċ = 0, too.
        let state = Simulation::new(system.clone(), state, tight(1e-6)).unwrap().state().clone();
        let mut simulation = Simulation::new(system.clone(), state, settings).unwrap();
        let before = momenta(&system, simulation.state());
        run(&mut simulation, 10.0);
        let after = momenta(&system, simulation.state());
        for k in 0..3 {
            // Impulses come in opposite pairs: only their roundoff remains, over up to 1e4 steps.
            assert_close(&format!("{integrator}: momentum {k}"), after[k], before[k], 1e-12);
            // RATTLE and symplectic Euler keep x × m v exactly, RK4 to its own error.
            assert_close(&format!("{integrator}: angular momentum {k}"), after[3 + k], before[3 + k], 1e-9);
        }
        let allowed = match integrator {
            Integrator::Rattle => 2e-4, // 3e-3 at a tolerance of 1e-4, smaller by its ⅔ power
            Integrator::Rk4 => 1e-9,
            _ => 2e-2, // order 1 at h ω = 5e-3
        };
        assert!(simulation.energy_error_max() < allowed, "{integrator}: {:e}", simulation.energy_error_max());
    }
}

/// Under gravity alone the centre of mass falls as a free particle, with any rods.
#[test]
fn centre_of_mass_falls_freely() {
    let (plain, state) = systems::free_structure();
    let mut builder = System::builder(qhat::Dimension::Three);
    for (i, (x, v)) in state.positions().chunks(3).zip(state.velocities().chunks(3)).enumerate() {
        builder.particle(qhat::Particle::at(format!("p{i}"), x).with_velocity(v).with_mass(plain.masses()[i]));
    }
    for named in plain.constraints() {
        builder.constraint(named.name.clone(), named.constraint.clone());
    }
    builder.force(Gravity { acceleration: [1.0, -9.0, 2.0] });
    let (system, state) = builder.build().unwrap();
    let mut simulation = Simulation::new(system.clone(), state, tight(1e-4)).unwrap();
    let centre = |state: &State, k: usize| {
        let sum: f64 = system.masses().iter().zip(state.positions().chunks(3)).map(|(m, x)| m * x[k]).sum();
        sum / system.masses().iter().sum::<f64>()
    };
    let total: f64 = system.masses().iter().sum();
    let start: [f64; 3] = std::array::from_fn(|k| centre(simulation.state(), k));
    let momentum = momenta(&system, simulation.state());
    run(&mut simulation, 2.0);
    let t = simulation.state().time();
    assert_close("t", t, 2.0, 1e-12);
    for (k, g) in [1.0, -9.0, 2.0].into_iter().enumerate() {
        // Störmer–Verlet is exact under a constant force: roundoff of some thousand substeps over 20 m.
        let expected = start[k] + momentum[k] / total * t + 0.5 * g * t * t;
        assert_close("centre of mass", centre(simulation.state(), k), expected, 1e-11);
    }
}

/// The sum of kinetic, potential and dissipated energy is constant: the account contains the energy that drag takes.
#[test]
fn long_damped_motion_closes_the_account() {
    for (integrator, h, allowed) in [
        // RATTLE and its trapezoidal account are of order 2: 4e-4 at the tolerance of 1e-4, smaller by its ⅔ power.
        // Were only one of them of order 1, 3e-5 would be left.
        (Integrator::Rattle, 1.0 / 60.0, 4e-6),
        // The work is summed with the weights of the method; (hω)⁴ at the 30 rad/s of the whip.
        (Integrator::Rk4, 1e-3, 1e-6),
        // Order 1: of 10 J, about hω at the mean 3 rad/s.
        (Integrator::SymplecticEuler, 1e-4, 2e-4),
        (Integrator::Euler, 1e-4, 2e-4),
        // These methods lose ½ m (h q̈)² in a step, an error of order 1 and of order 2; the whip has q̈ = 1e2 to 1e3
        // m/s².
        (Integrator::Implicit, 1e-4, 5e-3),
        (Integrator::Bdf2, 1e-4, 1e-5),
    ] {
        let (system, state) = systems::double_pendulum();
        let settings = Settings { integrator, h, ..tight(1e-8) };
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        simulation.set_drag(0.4).unwrap();
        let start = simulation.energy().balance();
        let (mut missing, mut kinetic) = (0.0_f64, 0.0_f64);
        for _ in 0..(3.0 / h).round() as usize {
            simulation.step().unwrap();
            missing = missing.max((simulation.energy().balance() - start).abs());
            kinetic = kinetic.max(simulation.energy().kinetic);
        }
        let taken = simulation.energy().work.dissipation;
        assert!(taken < -3.0, "drag took {taken} J");
        assert!(missing < allowed * kinetic, "{integrator}: {missing:e} J are missing in T + V − W, of {kinetic} J");
    }
}

/// A pendulum that drag brings to rest has lost exactly the potential energy of its height.
#[test]
fn drag_takes_all_there_was() {
    let (system, state) = systems::pendulum(2.0);
    let mut simulation = Simulation::new(system, state, tight(1e-7)).unwrap();
    simulation.set_drag(2.0).unwrap();
    run(&mut simulation, 40.0);
    let height = 1.0 - libm::cos(2.0);
    let lost = -simulation.energy().work.dissipation;
    assert!(simulation.energy().kinetic < 1e-12, "{:e}", simulation.energy().kinetic);
    // Order 2: an error of 1e-4 at a tolerance of 1e-5 becomes 5e-6 at 1e-7.
    assert_close("dissipated", lost, 2.0 * systems::G * height, 1e-5 * lost);
}

/// The hand that moves the mouse spring does work, which the account of energy contains.
#[test]
fn mouse_spring_work_is_booked() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, tight(1e-6)).unwrap();
    let start = simulation.energy().balance();
    assert_eq!(simulation.state().work().external, 0.0);
    let tip = crate::systems::id(2);
    simulation.grab(tip, [1.6, 1.8, 0.0]).unwrap();
    // A hand that grabs from one metre away stretches the spring: ½ ks · 1².
    let stiffness = simulation.mouse().unwrap().stiffness;
    assert_close("external work of the grip", simulation.state().work().external, 0.5 * stiffness, 1e-12 * stiffness);
    for frame in 0..120 {
        let angle = 0.05 * f64::from(frame);
        simulation.drag_to([libm::cos(angle), 1.0 + libm::sin(angle), 0.0]).unwrap();
        simulation.step().unwrap();
    }
    let before = simulation.state().work().external;
    let stored = simulation.energy().potential;
    simulation.release();
    // On release the energy of the spring goes back to the hand.
    let given_back = before - simulation.state().work().external;
    assert_close("given back", given_back, stored - simulation.energy().potential, 1e-12 * stiffness);
    assert!(given_back > 0.0 && simulation.mouse().is_none());
    let scale = simulation.energy().kinetic.max(stiffness);
    // RATTLE's error at this tolerance, 4e-5 of the energy that the hand puts in and the damper takes out.
    assert_close("T + V − W", simulation.energy().balance(), start, 1e-4 * scale);
    assert!(simulation.energy().work.dissipation < 0.0, "the spring is damped");
}

/// The work of feedback and elasticity through Q̂ is booked as stabilization. The account of explicit Euler closes with
/// an error of order 1.
#[test]
fn stabilization_work_is_booked() {
    let missing = |h: f64| {
        let (system, state) = systems::double_pendulum();
        let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Euler, h)).unwrap();
        simulation.set_feedback(Feedback { elasticity: 0.05, ..systems::critical(20.0) }).unwrap();
        let start = simulation.energy().balance();
        run(&mut simulation, 0.5);
        assert!(simulation.energy().work.stabilization.abs() > 1e-3);
        simulation.energy().balance() - start
    };
    let (coarse, fine) = (missing(1e-4), missing(5e-5));
    // Order 1: half the step gives half the error. If the work of Q̂ were not booked, both errors would be the same.
    assert_close("ratio", coarse / fine, 2.0, 0.05);
}

/// Changing gravity while it runs adds energy; the jump is booked as external.
#[test]
fn changes_while_running_are_booked() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, tight(1e-6)).unwrap();
    run(&mut simulation, 0.5);
    let before = simulation.energy();
    simulation.set_gravity([1.0, 3.0, 0.0]).unwrap();
    let after = simulation.energy();
    assert_eq!(simulation.gravity(), [1.0, 3.0, 0.0]);
    assert_eq!(after.kinetic, before.kinetic);
    let jump = after.potential - before.potential;
    assert!(jump.abs() > 1.0);
    assert_close("booked", after.work.external, jump, 1e-12 * jump.abs());
    simulation.reset().unwrap();
    assert_eq!(simulation.gravity(), [1.0, 3.0, 0.0], "reset keeps the forces");
    assert_eq!((simulation.state().time(), simulation.state().work()), (0.0, qhat::Work::default()));
}
