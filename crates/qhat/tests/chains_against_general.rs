//! Open chains in lanes against the general path: the same motion for all masses, ends and forces.

use crate::systems::open_chains::open_chains;
use crate::systems::{self, FRAME};
use qhat::{Dimension, Distance, Formulation, Integrator, Particle, Settings, Simulation, Solver, System, Warning};

#[test]
fn long_lanes_move_any_open_chains_as_the_general_path_does() {
    let settings = Settings { tolerance: 1e-11, ..systems::settings(Integrator::Dop853, FRAME) };
    let mut by_lanes = 0;
    for seed in 0..100 {
        let run = |is_general: bool| {
            let (system, state) = open_chains(seed, 1e5, is_general);
            let mut simulation = Simulation::new(system, state, settings).unwrap();
            let mut solver = None;
            for _ in 0..20 {
                let report = simulation.step().unwrap_or_else(|error| panic!("seed {seed}, {is_general}: {error}"));
                assert!(report.max_relative_length_error <= 1e-10, "seed {seed}");
                solver = Some(report.solver);
            }
            (simulation, solver.unwrap())
        };
        let ((lanes, by), (general, by_rows)) = (run(false), run(true));
        assert_eq!(by_rows, Solver::Rows, "seed {seed}");
        by_lanes += usize::from(by == Solver::Chains);
        let pairs = lanes.state().positions().iter().zip(general.state().positions());
        let farthest = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // Whipping chains multiply an error of 1e-11 a substep. At 1e-9 the two runs of one case ended 2e-4 m apart.
        assert!(farthest < 1e-6, "seed {seed}: {farthest:e} m apart");
        // Both accounts contain the energy that drag and dampers take.
        for simulation in [&lanes, &general] {
            assert!(simulation.energy_error().abs() < 1e-7, "seed {seed}: {:e}", simulation.energy_error());
        }
    }
    // A chain between two fixed ends leaves the lanes where its heavy beads line up: pivots of A do not tell masses
    // from a loss of rank.
    assert!(by_lanes >= 95, "{by_lanes} of 100 in lanes");
}

/// For the heaviest loads, w is close to zero.
#[test]
fn long_lanes_take_a_load_of_a_billion() {
    for seed in 0..20 {
        let (system, state) = open_chains(seed, 1e9, false);
        let settings = systems::settings(Integrator::Auto, FRAME);
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        for _ in 0..20 {
            let report = simulation.step().unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            assert!(report.max_relative_length_error <= 1e-10, "seed {seed}");
        }
    }
}

/// 500 rows a lane, each with a pivot of some 0.01 m²/kg: their product would be 1e-1000.
#[test]
fn long_stretches_keep_their_pivots_in_range() {
    let (system, state) = systems::chain(4000, 1.0);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Dop853, 1e-3)).unwrap();
    let report = simulation.step().unwrap();
    assert_eq!((report.solver, &report.warnings[..]), (Solver::Chains, &[][..]));
}

#[test]
fn the_classic_formulation_and_two_rods_between_the_same_particles() {
    let (system, state) = systems::chain(20, 10.0);
    let classic = system.with_formulation(Formulation::Classic);
    let run = |system: &System| {
        let settings = Settings { tolerance: 1e-9, ..systems::settings(Integrator::Dop853, FRAME) };
        let mut simulation = Simulation::new(system.clone(), state.clone(), settings).unwrap();
        let solver = (0..20).map(|_| simulation.step().unwrap().solver).last().unwrap();
        (simulation.state().positions().to_vec(), solver)
    };
    let ((lanes, by), (rows, by_rows)) = (run(&system), run(&classic));
    assert_eq!((by, by_rows), (Solver::Chains, Solver::Rows));
    assert!(lanes.iter().zip(&rows).all(|(a, b)| (a - b).abs() < 1e-6));

    for is_held in [false, true] {
        let mut builder = System::builder(Dimension::Two);
        let a = Particle::at("a", [0.0, 0.0]);
        let a = builder.particle(if is_held { a.fixed() } else { a });
        let b = builder.particle(Particle::at("b", [1.0, 0.0]));
        builder.with_constraint("one", Distance::new(a, b, 1.0)).constraint("other", Distance::new(b, a, 1.0));
        builder.force(systems::gravity());
        let (system, state) = builder.build().unwrap();
        let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Dop853, FRAME)).unwrap();
        for _ in 0..20 {
            let report = simulation.step().unwrap();
            assert_eq!(report.warnings, [Warning::Singular]);
        }
        assert!(simulation.energy_error().abs() < 1e-6);
    }
}
