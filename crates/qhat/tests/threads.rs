//! The same bits on any number of threads.

use crate::systems;
use qhat::{Integrator, Settings, Simulation, State, StepReport, run_all, step_all};
use rayon::ThreadPoolBuilder;

const THREADS: [usize; 4] = [1, 2, 8, 32];

/// Many chains in one system, and one chain long enough for its arrays to be cut.
fn large() -> Vec<Simulation> {
    let settings = Settings { integrator: Integrator::Dop853, h: 1e-3, ..Settings::default() };
    let systems = [systems::chains(900, 20), systems::chain(40_000, 1.0)];
    systems.into_iter().map(|(system, state)| Simulation::new(system, state, settings).unwrap()).collect()
}

fn run(threads: usize, mut simulations: Vec<Simulation>) -> Vec<(State, StepReport)> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut reports = Vec::new();
        for _ in 0..3 {
            reports = step_all(&mut simulations);
        }
        let states = simulations.iter().map(|simulation| simulation.state().clone());
        states.zip(reports.into_iter().map(Result::unwrap)).collect()
    })
}

#[test]
fn long_a_large_system_has_the_same_bits_on_any_number_of_threads() {
    let alone = run(1, large());
    for threads in THREADS {
        assert!(run(threads, large()) == alone, "{threads} threads");
    }
}

#[test]
fn many_systems_have_the_same_bits_on_any_number_of_threads() {
    let many = || {
        let settings = systems::settings(Integrator::Rattle, 0.01);
        let pendulums = (0..40).map(|k| systems::pendulum(0.05 * f64::from(k)));
        pendulums.map(|(system, state)| Simulation::new(system, state, settings).unwrap()).collect::<Vec<_>>()
    };
    let one_by_one: Vec<State> = many()
        .into_iter()
        .map(|mut simulation| {
            for _ in 0..3 {
                simulation.step().unwrap();
            }
            simulation.state().clone()
        })
        .collect();
    for threads in THREADS {
        let states: Vec<State> = run(threads, many()).into_iter().map(|(state, _)| state).collect();
        assert!(states == one_by_one, "{threads} threads");
    }
    // All frames of one after the other, in place of a frame of each.
    for threads in THREADS {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut simulations = many();
        let seen =
            pool.install(|| run_all(&mut simulations, 3, |place, simulation, _| (place, simulation.state().clone())));
        let last: Vec<State> = simulations.iter().map(|simulation| simulation.state().clone()).collect();
        assert!(last == one_by_one, "{threads} threads");
        for (place, seen) in seen.into_iter().enumerate() {
            let seen = seen.unwrap();
            assert_eq!((seen.len(), seen[2].0), (3, place));
            assert!(seen[2].1 == one_by_one[place]);
        }
    }
}
