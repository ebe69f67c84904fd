//! The integrator that auto chooses, and that the choice depends on the state only.

use crate::systems::{self, FRAME};
use qhat::{Integrator, Settings, Simulation, Solver, Warning, Workspace, step};

fn settings(frame_work: usize) -> Settings {
    Settings { frame_work, ..systems::settings(Integrator::Auto, FRAME) }
}

/// Auto runs dop853, bit for bit, as long as dop853 can follow the motion within its limits.
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

/// Under a load of a billion beads ω is 2e6/s and more: a frame would take thousands of substeps with h ω = 5, ten
/// times as many as it may.
#[test]
fn a_load_that_cannot_be_followed_is_carried_at_the_end_of_the_step() {
    let (system, state) = systems::chain(100, 1e9);
    let mut simulation = Simulation::new(system, state, settings(1_000_000)).unwrap();
    let mut at_the_end = 0;
    for _ in 0..120 {
        let report = simulation.step().unwrap();
        assert!(report.max_relative_length_error <= 1e-10);
        at_the_end += usize::from(report.solver == Solver::EndOfStep);
        if report.integrator == Integrator::Bdf2 {
            assert_eq!(report.solver, Solver::EndOfStep);
            assert!(matches!(report.warnings[0], Warning::TooStiff { .. }), "{:?}", report.warnings);
        }
    }
    // While the load falls, the tension is low enough for dop853; it is too high when the load swings through.
    assert!(at_the_end >= 30, "{at_the_end} frames of 120");
    // The pendulum loses little energy: a step solved at its end damps only motion that is too fast for h.
    assert!(simulation.energy_error().abs() < 0.05, "{:e}", simulation.energy_error());
}

#[test]
fn a_page_stays_within_its_work_and_tries_again() {
    let (system, state) = systems::chain(40, 100.0);
    // 25 substeps of 12 solves of 40 rows: too few for the crack of the whip, enough for the motion after it.
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
    // Once auto has changed to bdf2, it stays there for the rest of 30 frames.
    let first = chosen.iter().position(|&integrator| integrator == Integrator::Bdf2).unwrap();
    assert!(chosen[first..first + 30].iter().all(|&integrator| integrator == Integrator::Bdf2));
}

/// A run that is saved and loaded gives the same bits, also while auto waits for its next try of dop853.
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

/// A row of a net costs as much as sixteen rows of a chain: a limit of fifteen substeps of chain rows allows no substep
/// of a net.
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

/// A frame that is run in two parts ends at the same time as the whole frame, to the last bit.
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
