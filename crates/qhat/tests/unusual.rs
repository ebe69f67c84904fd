//! What few scenes have and every path must take: chains of any kind against the general path, nothing at all to move, a hand
//! that grabs within a run, odd durations, integrators that follow one another, loads and springs without measure.

mod systems;

use qhat::{
    Dimension, Distance, Drag, Formulation, Gravity, Integrator, MouseSpring, Nail, Particle, PointForce, Settings,
    Simulation, Solver, Spring, State, StepError, System, Warning,
};
use systems::random::Random;

const FRAME: f64 = 1.0 / 60.0;

/// Up to four open chains with any masses, ends held, nailed or free, some rods springs, and every kind of force on any
/// particle, held ones among them. `is_general` adds a triangle of rods far away, which no lane takes.
fn open_chains(seed: u64, heavy: f64, is_general: bool) -> (System, State) {
    let random = &mut Random::new(seed);
    let dimension = if random.below(2) == 0 { Dimension::Two } else { Dimension::Three };
    let d = dimension.number();
    let mut builder = System::builder(dimension);
    let mut count = 0;
    for chain in 0..1 + random.below(4) {
        let links = [0, 1, 3, 9, 17, 40][random.below(6)];
        let mut x: Vec<f64> = (0..d).map(|_| 3.0 * random.within(-1.0, 1.0)).collect();
        let (first, last) = (random.below(4), random.below(4));
        for i in 0..=links {
            let mass = if random.below(20) == 0 { heavy } else { [0.01, 0.1, 1.0, 10.0, 100.0][random.below(5)] };
            let particle = Particle::at(format!("{chain}-{i}"), x.clone()).with_mass(mass);
            let (is_first, is_last) = (i == 0, i == links && links > 0);
            let is_held = is_first && first == 0 || is_last && last == 0;
            let id = builder.particle(if is_held { particle.fixed() } else { particle });
            count += 1;
            if is_first && first == 1 || is_last && last == 1 {
                builder.constraint(
                    format!("nail {chain}-{i}"),
                    Nail::new(id, std::array::from_fn::<_, 3, _>(|c| *x.get(c).unwrap_or(&0.0))),
                );
            }
            let step: Vec<f64> =
                (0..d).map(|c| 0.3 * random.within(-1.0, 1.0) + if c == 0 { 0.5 } else { 0.0 }).collect();
            let length = step.iter().map(|s| s * s).sum::<f64>().sqrt();
            if i < links {
                let rod = Distance::new(id, systems::id(id.index() + 1), length);
                let is_soft = random.below(12) == 0;
                // Both ends held, by one rod: not for lanes.
                let rod = if is_soft || links == 1 { rod.with_compliance(1e-2, 0.1) } else { rod };
                builder.constraint(format!("rod {chain}-{i}"), rod);
            }
            for (x, step) in x.iter_mut().zip(step) {
                *x += step;
            }
        }
    }
    builder.force(Gravity { acceleration: [0.3, -9.81, 1.0] });
    if random.below(2) == 0 {
        builder.with_force(Drag { coefficient: 0.1 }).force(Drag { coefficient: 0.02 });
    }
    let any = |random: &mut Random| systems::id(random.below(count));
    builder.force(PointForce { particle: any(random), force: [0.01, 0.02, 0.03] });
    builder.force(MouseSpring { particle: any(random), target: [1.0, 0.0, 0.0], stiffness: 0.5, damping: 0.01 });
    for _ in 0..3 {
        let (a, b) = (any(random), any(random));
        if a != b {
            builder.force(Spring { a, b, stiffness: 0.3, damping: 0.02, rest: 0.5 });
        }
    }
    if is_general {
        let corners = [[1e3, 0.0, 0.0], [1e3 + 0.5, 0.0, 0.0], [1e3, 0.5, 0.0]];
        let corners = corners.map(|x| {
            count += 1;
            builder.particle(Particle::at(format!("corner {count}"), &x[..d]))
        });
        for (k, length) in [0.5, 0.5 * 2.0_f64.sqrt(), 0.5].into_iter().enumerate() {
            builder.constraint(format!("side {k}"), Distance::new(corners[k], corners[(k + 1) % 3], length));
        }
    }
    builder.build().unwrap()
}

#[test]
fn lanes_move_any_open_chains_as_the_general_path_does() {
    let settings = Settings { tolerance: 1e-11, ..systems::settings(Integrator::Dop853, FRAME) };
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
        assert_eq!((by, by_rows), (Solver::Chains, Solver::Rows), "seed {seed}");
        let pairs = lanes.state().positions().iter().zip(general.state().positions());
        let farthest = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        // Whipping chains multiply an error of 1e-11 a substep; at 1e-9 one of these came out 2e-4 m apart.
        assert!(farthest < 1e-6, "seed {seed}: {farthest:e} m apart");
        // What drag and dampers take is in the account of both.
        for simulation in [&lanes, &general] {
            assert!(simulation.energy_error().abs() < 1e-7, "seed {seed}: {:e}", simulation.energy_error());
        }
    }
}

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

/// Each follows each, with frames of odd length, a hand that comes and goes, and gravity and drag that change.
#[test]
fn integrators_follow_one_another() {
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
                1 => simulation.grab(systems::id(1), [0.5; 3]).unwrap(),
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

/// A limit of the whole run is auto's limit, too: a frame that does not arrive within it goes over, and does not fail.
#[test]
fn auto_goes_over_where_substeps_are_limited() {
    let (system, state) = systems::double_pendulum();
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, 1e-3)).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    // Its substeps are known by now, and none is taken back.
    let report = simulation.clone().advance(0.5).unwrap();
    assert_eq!((report.integrator, report.rejected), (Integrator::Dop853, 0));
    let max_substeps = report.substeps / 2;
    simulation.set_settings(Settings { max_substeps, ..*simulation.settings() }).unwrap();
    let report = simulation.advance(0.5).unwrap();
    assert_eq!((report.integrator, report.rejected), (Integrator::Bdf2, 0));
    assert_eq!(simulation.state().time(), 0.52);
}

/// The first substep tried overflows; a shorter one does not.
#[test]
fn springs_without_measure_do_not_end_a_run() {
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
                // 200 000 substeps are enough for the first.
                assert_eq!(report.integrator == Integrator::Dop853, stiffness < 1e13);
            }
        }
    }
}

/// Of the heaviest loads the lanes see no more than a small w.
#[test]
fn lanes_take_a_load_of_a_billion() {
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

/// Masses 1e11 apart in one chain: what rattle corrects in a position is lost in roundoff, and dopri5 in lanes carries on.
#[test]
fn where_rattle_stalls_dopri5_carries_on() {
    let (system, state) = open_chains(91, 1e9, false);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Rattle, FRAME)).unwrap();
    let mut handed_over = 0;
    for frame in 1..=20 {
        let report = simulation.step().unwrap_or_else(|error| panic!("frame {frame}: {error}"));
        assert!(report.max_relative_length_error <= 1e-10, "frame {frame}");
        let warned = report.warnings.iter().any(|warning| matches!(warning, Warning::HandedOver { .. }));
        assert_eq!(warned, report.integrator == Integrator::Dopri5, "frame {frame}");
        assert!(report.substeps > 0 && report.smallest_substep <= FRAME, "frame {frame}");
        handed_over += usize::from(warned);
    }
    assert!((1..20).contains(&handed_over), "{handed_over} frames");
    assert!((simulation.state().time() - 20.0 * FRAME).abs() < 1e-14, "frames add up but for rounding");
}
