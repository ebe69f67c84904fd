//! A run that is saved and loaded at any step gives the same bits as a run without a stop: a State holds all that a
//! restart needs, and a Workspace holds nothing that changes a result.

use crate::systems;
use qhat::{Integrator, Settings, Simulation, State, System, Workspace, evaluate, step};

fn bits(state: &State) -> Vec<u64> {
    let work = state.work();
    let numbers = [state.time(), work.dissipation, work.stabilization, work.external, work.drives];
    state.positions().iter().chain(state.velocities()).chain(&numbers).map(|x| x.to_bits()).collect()
}

/// Systems with springs and drag, beyond the dense limit, in 3D, and with redundant rows.
fn cases() -> Vec<(&'static str, System, State)> {
    let mut random = systems::random::Random::new(21);
    let mut cases = Vec::new();
    let mut add = |name, (system, state)| cases.push((name, system, state));
    add("double pendulum", systems::double_pendulum());
    add("chain of 30", systems::chain(30, 10.0));
    add("net", systems::net(4));
    add("redundant truss", systems::truss(5, true));
    add("free structure", systems::free_structure());
    add("web", systems::random::web(&mut random, 2, 5));
    cases
}

fn settings(integrator: Integrator) -> Settings {
    systems::settings(integrator, if integrator.is_adaptive() { 1.0 / 60.0 } else { 2e-4 })
}

#[test]
fn long_a_fresh_workspace_changes_no_bit_for_any_integrator() {
    for integrator in Integrator::ALL {
        let settings = settings(integrator);
        for (name, system, start) in cases() {
            let Ok(simulation) = Simulation::new(system.clone(), start, settings) else {
                // The web starts off its constraints, and its random lengths cannot be met.
                assert!(name == "web" && integrator.projects(), "{name} under {integrator}");
                continue;
            };
            let mut state = simulation.state().clone();
            let mut kept = Workspace::new(&system);
            for frame in 0..30 {
                let mut restarted = state.clone();
                let again = step(&system, &mut restarted, &settings, &mut Workspace::new(&system)).unwrap();
                let report = step(&system, &mut state, &settings, &mut kept).unwrap();
                assert_eq!(bits(&state), bits(&restarted), "{name} under {integrator}, frame {frame}");
                assert_eq!(state, restarted, "{name} under {integrator}, frame {frame}: what is carried");
                assert_eq!(report.substeps, again.substeps);
                assert_eq!(report.energy, again.energy);
            }
        }
    }
}

/// A workspace that another run has used gives the same bits, too.
#[test]
fn a_used_workspace_changes_no_bit() {
    for integrator in Integrator::ALL {
        let settings = settings(integrator);
        for (name, system, state) in cases().into_iter().take(5) {
            let start = Simulation::new(system.clone(), state, settings).unwrap().state().clone();
            let mut workspace = Workspace::new(&system);
            let once = |workspace: &mut Workspace| {
                let mut state = start.clone();
                for _ in 0..5 {
                    step(&system, &mut state, &settings, workspace).unwrap();
                }
                bits(&state)
            };
            let first = once(&mut workspace);
            assert_eq!(first, once(&mut workspace), "{name} under {integrator}");
            // Another integrator has left its data in the middle of another motion.
            let mut elsewhere = start.clone();
            let other = systems::settings(Integrator::Euler, 1e-4);
            step(&system, &mut elsewhere, &other, &mut workspace).unwrap();
            assert_eq!(first, once(&mut workspace), "{name} under {integrator}, after Euler");
        }
    }
}

/// Reading terms, tension or energy between the steps does not change the motion.
#[test]
fn looking_changes_no_bit() {
    for integrator in Integrator::ALL {
        for (name, system, state) in cases().into_iter().take(5) {
            let mut blind = Simulation::new(system.clone(), state.clone(), settings(integrator)).unwrap();
            let mut curious = Simulation::new(system, state, settings(integrator)).unwrap();
            for _ in 0..10 {
                let (terms, tension) = (curious.terms(), curious.tension());
                assert_eq!(terms.tension, tension);
                curious.energy();
                blind.step().unwrap();
                curious.step().unwrap();
                assert_eq!(bits(blind.state()), bits(curious.state()), "{name} under {integrator}");
            }
        }
    }
}

/// evaluate() is a function of system and state alone.
#[test]
fn evaluating_twice_gives_the_same_bits() {
    for (name, system, state) in cases() {
        assert_eq!(evaluate(&system, &state), evaluate(&system.clone(), &state.clone()), "{name}");
    }
}

/// reset() goes back to the first frame, bit for bit.
#[test]
fn reset_starts_again_with_the_same_bits() {
    for integrator in Integrator::ALL {
        for (name, system, state) in cases().into_iter().take(5) {
            let mut simulation = Simulation::new(system, state, settings(integrator)).unwrap();
            let run = |simulation: &mut Simulation| -> Vec<Vec<u64>> {
                (0..8)
                    .map(|_| {
                        simulation.step().unwrap();
                        bits(simulation.state())
                    })
                    .collect()
            };
            let first = run(&mut simulation);
            simulation.reset().unwrap();
            assert_eq!(first, run(&mut simulation), "{name} under {integrator}");
        }
    }
}
