//! The workloads have the shapes that their names promise, and errors are measured as they are defined.

use qhat_bench::trajectory::{Writer, measure};
use qhat_bench::{Errors, NAMES, Setting, Workload, run, settings};
use std::time::Duration;

fn workload(name: &str) -> Workload {
    name.parse().unwrap()
}

#[test]
fn every_rod_is_as_long_as_its_ends_are_apart() {
    for name in NAMES.iter().filter(|name| !name.contains("e6") && !name.contains("316")) {
        let workload = workload(name);
        let mut errors = Errors::of(&workload);
        errors.frame(&workload, &workload.positions, &vec![0.0; workload.positions.len()]);
        // Roundoff of a position over the length of a rod: a chain of 1e5 links ends at x = 1000 m.
        let far = workload.positions.iter().fold(1.0_f64, |far, x| far.max(x.abs()));
        assert!(errors.worst_length <= 2.0 * far * f64::EPSILON / 0.01, "{name}: {}", errors.worst_length);
    }
}

#[test]
fn shapes_have_as_many_particles_and_rods_as_their_names_say() {
    for (name, particles, rods) in [
        ("chain100", 101, 100),
        ("heavy1000", 101, 100),
        ("net32", 1024, 2 * 32 * 31),
        ("cloth32", 1024, 2 * 32 * 31),
        // Statically determinate: 2n − 3 rods hold the joints of a planar truss.
        ("truss20", 41, 2 * 41 - 3),
        ("truss20r", 41, 2 * 41 - 2),
        ("four-bar", 4, 3),
        ("star1000", 1001, 1000),
        ("many10000", 210_000, 200_000),
        ("chain1e5", 100_001, 100_000),
    ] {
        let workload = workload(name);
        assert_eq!((workload.particle_count(), workload.lengths.len()), (particles, rods), "{name}");
        assert_eq!(workload.name, name);
    }
    assert_eq!(workload("heavy1000").masses[100], 10.0);
}

#[test]
fn names_that_are_none_are_refused() {
    for name in [
        "",
        "chain",
        "chain0",
        "chain1.5",
        "chain100r",
        "rope5",
        "truss2",
        "five-bar",
        "chain1e9",
        "net1",
        "net1e7",
        "cloth4000",
        "many1e6",
    ] {
        assert!(name.parse::<Workload>().is_err(), "{name}");
    }
    let message = "rope".parse::<Workload>().unwrap_err().to_string();
    assert!(message.contains("`rope`") && message.contains("chain100"), "{message}");
}

#[test]
fn settings_read_back_as_they_are_written() {
    for setting in settings(&workload("chain10")) {
        assert_eq!(setting.to_string().parse::<Setting>().unwrap(), setting);
    }
    for words in ["dop853", "dop853:", "dop853:2", "verlet:1e-4"] {
        assert!(words.parse::<Setting>().is_err(), "{words}");
    }
}

/// Errors computed by hand from the definitions: a rod of 0.01 m is stretched by a tenth, and its particle of 0.01 kg
/// slows down or is lowered by h = 0.002 m.
#[test]
fn errors_are_those_of_the_definitions() {
    let pendulum = workload("chain1");
    let mut errors = Errors::of(&pendulum);
    errors.frame(&pendulum, &[0.0, 0.0, 0.01, 0.0], &[0.0, 0.0, 0.0, 1.0]);
    errors.frame(&pendulum, &[0.0, 0.0, 0.011, 0.0], &[0.0, 0.0, 0.0, 0.5]);
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-14; // roundoff of numbers near 1
    assert!(near(errors.worst_length, 0.1), "{}", errors.worst_length);
    assert!(near(errors.rms_length(), 0.1 / 2.0_f64.sqrt()), "{}", errors.rms_length());
    // The largest T is ½ 0.01 1² = 0.005 J. At the end T is a quarter of it. V and the energy at the start are 0.
    assert!(near(errors.energy(), 0.25), "{}", errors.energy());
    assert!(near(errors.energy_max(), 1.0), "{}", errors.energy_max());
    errors.frame(&pendulum, &[0.0, 0.0, 0.01, -0.002], &[0.0; 4]);
    assert!(near(errors.energy(), -0.01 * 9.81 * 0.002 / 0.005), "{}", errors.energy());
}

#[test]
fn a_trajectory_tells_the_errors_of_its_run() {
    let (workload, setting) = (workload("chain10"), "dop853:1e-4".parse().unwrap());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("chain10.f64");
    let mut writer = Writer::create(&file).unwrap();
    let outcome = run(&workload, &setting, Duration::MAX, |q, qd| writer.frame(q, qd).unwrap()).unwrap();
    writer.finish().unwrap();
    let (frames, errors) = measure(&workload, &file).unwrap();
    assert_eq!((frames, &outcome.ended), (workload.frames, &None));
    assert_eq!(errors.worst_length, outcome.errors.worst_length);
    assert_eq!(errors.energy(), outcome.errors.energy());
    // The constraint tolerance, and the energy that a tolerance of 1e-4 keeps.
    assert!(errors.worst_length <= 1e-10 && errors.energy().abs() <= 1e-2, "{errors:?}");
}

#[test]
fn a_run_that_costs_too_much_is_stopped_and_says_so() {
    let (workload, setting) = (workload("chain10"), "dop853:1e-4".parse().unwrap());
    let outcome = run(&workload, &setting, Duration::ZERO, |_, _| ()).unwrap();
    assert!((outcome.simulated - workload.frame).abs() < 1e-12 && outcome.ended.is_some(), "{outcome:?}");
}
