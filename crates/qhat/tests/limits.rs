//! Unusual requests: systems in which nothing moves, odd durations, a hand that grabs during a run, changes of the
//! integrator, extreme loads and springs.

use crate::systems::open_chains::open_chains;
use crate::systems::{self, FRAME};
use qhat::{Dimension, Distance, Integrator, Particle, Settings, Simulation, Spring, StepError, System, Warning};

#[test]
fn nothing_to_move_and_one_free_particle() {
    for integrator in Integrator::ALL {
        for dimension in [Dimension::Two, Dimension::Three] {
            let (system, state) = System::builder(dimension).build().unwrap();
            let mut simulation = Simulation::new(system, state, systems::settings(integrator, 0.25)).unwrap();
            simulation.step().unwrap();
            assert_eq!(simulation.state().time(), 0.25);
            let mut builder = System::builder(dimension);
            builder.particle(Particle::at("fixed", vec![1.0; dimension.number()]).fixed());
            builder.particle(Particle::at("free", vec![0.0; dimension.number()]));
            builder.force(systems::gravity());
            let (system, state) = builder.build().unwrap();
            let mut simulation = Simulation::new(system, state, systems::settings(integrator, 0.25)).unwrap();
            for _ in 0..4 {
                simulation.step().unwrap();
            }
            if integrator.order() > 2 {
                let fallen = simulation.state().positions()[dimension.number() + 1];
                assert!((fallen + 0.5 * systems::G).abs() < 1e-12, "{integrator}: {fallen}");
            }
        }
    }
}

#[test]
fn a_duration_must_be_positive() {
    for integrator in Integrator::ALL {
        let (system, state) = systems::double_pendulum();
        let mut simulation = Simulation::new(system, state, systems::settings(integrator, FRAME)).unwrap();
        simulation.step().unwrap();
        let before = simulation.state().clone();
        for duration in [0.0, -FRAME, f64::NAN, f64::INFINITY] {
            let refused = simulation.advance(duration);
            assert!(matches!(refused, Err(StepError::Settings(_))), "{integrator}, {duration} s: {refused:?}");
        }
        assert_eq!(simulation.state(), &before, "{integrator}");
        simulation.step().unwrap();
    }
}

/// Every integrator follows every other, with frames of odd length, a hand that grabs and releases, and gravity and
/// drag that change.
#[test]
fn long_integrators_follow_one_another() {
    for seed in [3, 8, 11] {
        let (system, state) = open_chains(seed, 1.0, false);
        let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, FRAME)).unwrap();
        let all = [
            Integrator::Dop853,
            Integrator::Rattle,
            Integrator::Auto,
            Integrator::Bdf2,
            Integrator::Auto,
            Integrator::Implicit,
            Integrator::Dopri5,
            Integrator::Bdf2,
            Integrator::Dop853,
            Integrator::Rattle,
        ];
        for (k, integrator) in all.into_iter().cycle().take(30).enumerate() {
            let settings = systems::settings(integrator, FRAME * (1.0 + 0.37 * (k % 5) as f64));
            simulation.set_settings(settings).unwrap();
            match k % 7 {
                1 => simulation.grab(crate::systems::id(1), [0.5; 3]).unwrap(),
                3 => simulation.set_gravity([0.0, -1.0, 0.5]).unwrap(),
                4 => simulation.set_drag(0.3).unwrap(),
                5 => simulation.release(),
                _ => {}
            }
            let report = simulation.step().unwrap_or_else(|error| panic!("seed {seed}, {k}, {integrator}: {error}"));
            assert!(report.max_relative_length_error <= 1e-10, "seed {seed}, {k}, {integrator}");
        }
        assert!(simulation.state().positions().iter().all(|x| x.abs() < 100.0), "seed {seed}");
    }
}

/// The limit of substeps is auto's limit, too: if a frame would exceed it, auto changes to bdf2 and the frame does not
/// fail.
#[test]
fn auto_goes_over_where_substeps_are_limited() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, 1e-3)).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    // The substep is adapted by now, and no substep is rejected.
    let report = simulation.clone().advance(0.5).unwrap();
    assert_eq!((report.integrator, report.rejected), (Integrator::Dop853, 0));
    let max_substeps = report.substeps / 2;
    simulation.set_settings(Settings { max_substeps, ..*simulation.settings() }).unwrap();
    let report = simulation.advance(0.5).unwrap();
    assert_eq!((report.integrator, report.rejected), (Integrator::Bdf2, 0));
    assert_eq!(simulation.state().time(), 0.52);
}

/// The first substep overflows and is rejected; a shorter substep succeeds.
#[test]
fn long_springs_without_measure_do_not_end_a_run() {
    for stiffness in [1e12, 1e16, 1e20, 1e24] {
        for is_general in [false, true] {
            let (system, state) = {
                let mut builder = System::builder(Dimension::Two);
                let a = builder.particle(Particle::at("a", [0.0, 0.0]).fixed());
                let b = builder.particle(Particle::at("b", [1.0, 0.0]));
                let c = builder.particle(Particle::at("c", [1.5, 0.0]));
                builder.constraint("bc", Distance::new(b, c, 0.5));
                if is_general {
                    let d = builder.particle(Particle::at("d", [1.2, 0.4]));
                    builder
                        .with_constraint("cd", Distance::new(c, d, 0.5))
                        .constraint("db", Distance::new(d, b, 0.4472135954999579));
                }
                builder.with_force(Spring { a, b, stiffness, damping: 0.0, rest: 0.99 }).force(systems::gravity());
                builder.build().unwrap()
            };
            let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, FRAME)).unwrap();
            for frame in 0..10 {
                let report = simulation
                    .step()
                    .unwrap_or_else(|error| panic!("{stiffness:e} N/m, general {is_general}, frame {frame}: {error}"));
                // 200 000 substeps are enough for the first case.
                assert_eq!(report.integrator == Integrator::Dop853, stiffness < 1e13);
            }
        }
    }
}

/// Masses that differ by 1e11 in one chain: rattle follows them, or hands the frame over to dopri5 and says so.
#[test]
fn rattle_follows_masses_1e11_apart_or_hands_over() {
    let (system, state) = open_chains(91, 1e9, false);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rattle, FRAME)).unwrap();
    for frame in 1..=20 {
        let report = simulation.step().unwrap_or_else(|error| panic!("frame {frame}: {error}"));
        assert!(report.max_relative_length_error <= 1e-10, "frame {frame}");
        let warned = report.warnings.iter().any(|warning| matches!(warning, Warning::HandedOver { .. }));
        assert_eq!(warned, report.integrator == Integrator::Dopri5, "frame {frame}");
        assert!(report.substeps > 0 && report.smallest_substep <= FRAME, "frame {frame}");
    }
    assert!((simulation.state().time() - 20.0 * FRAME).abs() < 1e-14, "frames add up but for rounding");
}
