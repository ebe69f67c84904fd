//! What auto chooses, and that its choice depends on nothing but the state.

use crate::systems::{self, FRAME};
use qhat::{Integrator, Settings, Simulation, Solver, Warning, Workspace, step};

fn settings(frame_work: usize) -> Settings {
    Settings { frame_work, ..systems::settings(Integrator::Auto, FRAME) }
}

/// What can be followed is dop853's, bit for bit.
#[test]
fn long_with_work_to_spare_it_is_dop853() {
    for (system, state) in [systems::chain(100, 1000.0), systems::net(4), systems::double_pendulum()] {
        let mut auto =
            Simulation::new(system.clone(), state.clone(), systems::settings(Integrator::Auto, FRAME)).unwrap();
        let mut dop853 = Simulation::new(system, state, systems::settings(Integrator::Dop853, FRAME)).unwrap();
        for _ in 0..30 {
            let report = auto.step().unwrap();
            dop853.step().unwrap();
            assert_eq!(report.integrator, Integrator::Dop853);
            assert_eq!(report.warnings, []);
        }
        assert_eq!(auto.state().positions(), dop853.state().positions());
    }
}

/// Under a billion beads ω is 2e6/s and more, thousands of substeps of h ω = 5 a frame.
#[test]
fn a_load_that_cannot_be_followed_is_carried_at_the_end_of_the_step() {
    let (system, state) = systems::chain(100, 1e9);
    let mut simulation = Simulation::new(system, state, systems::settings(Integrator::Auto, FRAME)).unwrap();
    let mut by_bdf2 = 0;
    for _ in 0..120 {
        let report = simulation.step().unwrap();
        assert!(report.max_relative_length_error <= 1e-10);
        if report.integrator == Integrator::Bdf2 {
            by_bdf2 += 1;
            assert_eq!(report.solver, Solver::EndOfStep);
            assert!(matches!(report.warnings[..], [Warning::TooStiff { .. }]), "{:?}", report.warnings);
        }
    }
    // While the load falls the chain is slack enough; it is not where the load swings through.
    assert!(by_bdf2 >= 30, "{by_bdf2} frames of 120");
    // Its pendulum loses little: bdf2 damps what h cannot show, and nothing else.
    assert!(simulation.energy_error().abs() < 0.05, "{:e}", simulation.energy_error());
}

#[test]
fn a_page_stays_within_its_work_and_tries_again() {
    let (system, state) = systems::chain(40, 100.0);
    // 25 substeps of 12 solves of 40 rows: too few for the crack, enough for what comes after.
    let mut simulation = Simulation::new(system, state, settings(12_000)).unwrap();
    let mut chosen = Vec::new();
    for _ in 0..240 {
        let report = simulation.step().unwrap();
        assert!(report.max_relative_length_error <= 1e-10);
        assert!(report.substeps + report.rejected <= 2 * 25, "{} substeps", report.substeps + report.rejected);
        chosen.push(report.integrator);
    }
    let changes = chosen.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes >= 2, "it went over and came back: {changes} changes");
    // Once gone over, it stays for the rest of 30 frames.
    let first = chosen.iter().position(|&integrator| integrator == Integrator::Bdf2).unwrap();
    assert!(chosen[first..first + 30].iter().all(|&integrator| integrator == Integrator::Bdf2));
}

/// Save, load, go on: also in the middle of resting.
#[test]
fn a_restart_changes_no_bit() {
    let (system, state) = systems::chain(40, 100.0);
    let settings = settings(12_000);
    let mut kept = Workspace::new(&system);
    let mut state = Simulation::new(system.clone(), state, settings).unwrap().state().clone();
    for frame in 0..120 {
        let mut restarted = state.clone();
        let again = step(&system, &mut restarted, &settings, &mut Workspace::new(&system)).unwrap();
        let report = step(&system, &mut state, &settings, &mut kept).unwrap();
        assert!(state == restarted, "frame {frame}");
        assert_eq!(report.integrator, again.integrator);
    }
}

/// A row of a net takes as long as sixteen of a chain: fifteen substeps' worth of chain rows allow none of a net.
#[test]
fn rows_outside_the_lanes_count_sixteenfold() {
    for ((system, state), expected) in
        [(systems::net(4), Integrator::Bdf2), (systems::chain(40, 1.0), Integrator::Dop853)]
    {
        let settings = settings(15 * 12 * system.row_count());
        let mut simulation = Simulation::new(system, state, settings).unwrap();
        assert_eq!(simulation.step().unwrap().integrator, expected);
    }
}

/// A frame in two parts ends where the frame ends, to the last bit.
#[test]
fn time_goes_in_whole_frames() {
    let (system, state) = systems::chain(40, 100.0);
    let mut simulation = Simulation::new(system, state, settings(12_000)).unwrap();
    let mut expected = 0.0;
    for _ in 0..60 {
        simulation.step().unwrap();
        expected += FRAME;
        assert_eq!(simulation.state().time(), expected);
    }
}
