//! The shipped scenes: every file is in the list, every expectation holds, and every rod has its length.

use crate::expectations;
use qhat::{Feedback, Integrator, Settings, Simulation};
use qhat_scene::{Format, Scene, load, shipped};
use std::collections::BTreeSet;
use std::path::Path;

/// Least simulated time over which lengths are checked [s].
const LONG: f64 = 60.0;

fn scene(name: &str) -> Scene {
    let found = shipped().iter().find(|scene| scene.name == name).expect(name);
    found.load().unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn the_list_is_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files: BTreeSet<String> = files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    // A listed scene without a file does not compile.
    let listed: BTreeSet<String> = shipped().iter().map(|scene| scene.name.to_owned()).collect();
    let missing: Vec<&String> = files.difference(&listed).collect();
    assert!(
        missing.is_empty(),
        "in no list: {missing:?}; add them under a heading in crates/qhat-scene/src/shipped.rs"
    );
    let twice = shipped().iter().enumerate();
    let twice: Vec<&str> = twice
        .filter(|(index, scene)| shipped()[..*index].iter().any(|other| other.name == scene.name))
        .map(|(_, scene)| scene.name)
        .collect();
    assert!(twice.is_empty(), "listed twice in crates/qhat-scene/src/shipped.rs: {twice:?}");
    assert!(listed.len() >= 12);
}

/// The scenes of a heading follow each other, because lists show the scenes heading by heading.
#[test]
fn every_heading_is_there_once() {
    let mut headings: Vec<&str> = shipped().iter().map(|scene| scene.group).collect();
    headings.dedup();
    let different: BTreeSet<&str> = headings.iter().copied().collect();
    assert_eq!(headings.len(), different.len(), "{headings:?}");
    assert!(headings.iter().all(|heading| !heading.is_empty()));
}

#[test]
fn every_scene_says_what_there_is_to_see() {
    for shipped in shipped() {
        let scene = scene(shipped.name);
        assert_eq!(shipped.title, scene.name);
        assert!(scene.description.len() >= 40, "{}: {:?}", shipped.name, scene.description);
        assert!(scene.expect.is_some(), "{} expects nothing", shipped.name);
        let expects_length = scene.expect.and_then(|expect| expect.max_relative_length_error);
        if scene.settings.integrator.projects() && scene.system.links().any(|link| link.is_rod()) {
            assert!(expects_length.is_some_and(|error| error <= 1e-10), "{} promises no length", shipped.name);
        }
    }
}

/// The start in a file may differ from the projected start only by the rounding of its decimals: the run starts at the
/// numbers that a user reads.
#[test]
fn every_scene_starts_where_its_file_says() {
    for shipped in shipped() {
        let simulation = scene(shipped.name).simulation().unwrap();
        let projection = simulation.projection();
        // Coordinates carry 12 digits, velocities 9.
        assert!(projection.moved <= 1e-10, "{} was moved by {} m", shipped.name, projection.moved);
        assert!(projection.velocity_changed <= 1e-7, "{}: {} m/s", shipped.name, projection.velocity_changed);
    }
}

#[test]
fn long_every_scene_shows_what_it_says() {
    let failures: Vec<String> = std::thread::scope(|scope| {
        let run = |name| move || (name, expectations::failures(&scene(name), LONG));
        let runs: Vec<_> = shipped().iter().map(|shipped| scope.spawn(run(shipped.name))).collect();
        let found = runs.into_iter().map(|run| run.join().expect("no scene panics"));
        found.flat_map(|(name, found)| found.into_iter().map(move |failure| format!("{name}: {failure}"))).collect()
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A pendulum released from the horizontal under explicit Euler gains energy and leaves the circle. Each of these
/// expectations is false for it, and the check reports each.
#[test]
fn an_expectation_that_does_not_hold_is_found() {
    let pendulum = shipped().iter().find(|scene| scene.name == "pendulum").unwrap();
    let (text, _) = pendulum.text.split_once("[expect]").unwrap();
    let text = text.replace("duration = 10.0", "duration = 1.0\nintegrator = \"euler\"");
    for (untrue, found) in [
        ("degrees_of_freedom = 2", "degrees of freedom"),
        ("max_residual = 1e-6", "a row was off"),
        ("broken = ['pivot-bob']", "broken at the end"),
        ("energy_never_rises = true", "the energy rose"),
        ("energy_error = 1e-9", "energy error"),
        ("at_end = [{ particle = 'bob', axis = 'y', value = 0.5, tolerance = 0.1 }]", "bob ended at"),
        ("speed_at_end = [{ particle = 'bob', value = 0.0, tolerance = 1.0 }]", "m/s, expected 0"),
        ("motion = [{ particle = 'bob', axis = 'y', within = [-0.5, 0.1] }]", "bob went from"),
        ("tension = [{ rod = 'pivot-bob', value = -100.0, tolerance = 1.0 }]", "tension"),
        ("period = { particle = 'bob', axis = 'x', value = 1.0, tolerance = 0.1 }", "period"),
    ] {
        let text = format!("{text}\n[expect]\n{untrue}\n");
        let scene = load(&text, untrue, Format::Toml).unwrap_or_else(|errors| panic!("{errors}"));
        let failures = expectations::failures(&scene, LONG);
        assert!(failures.len() == 1 && failures[0].contains(found), "{untrue}: {failures:?}");
    }
    let silent = load(&text, "nothing expected", Format::Toml).unwrap();
    assert_eq!(expectations::failures(&silent, LONG), Vec::<String>::new());
}

/// Runs for a duration with these settings of the two menus; returns the time at which the scene diverged.
fn falls_apart(scene: &Scene, feedback: Feedback, duration: f64) -> Option<f64> {
    let mut simulation = scene.simulation().unwrap();
    simulation.set_feedback(feedback).unwrap();
    while simulation.state().time() < duration {
        if simulation.step().is_err() {
            return Some(simulation.state().time());
        }
    }
    None
}

/// The purpose of the scene: only the two menus of the source keep it from diverging.
#[test]
fn long_classic_needs_both_its_menus() {
    let scene = scene("classic");
    let menus = *scene.system.feedback();
    assert_eq!(scene.settings.integrator, Integrator::Euler);
    assert_eq!(falls_apart(&scene, menus, 10.0 * scene.duration), None);
    assert!(falls_apart(&scene, Feedback { elasticity: 0.0, ..menus }, 10.0).is_some());
    assert!(falls_apart(&scene, Feedback { diagonal_drag: 0.1 * menus.diagonal_drag, ..menus }, 10.0).is_some());
}

/// The same scene in the modern forms under rattle needs neither menu.
#[test]
fn long_classic_holds_under_rattle() {
    let scene = scene("classic");
    let system = scene.system.with_formulation(qhat::Formulation::Modern);
    let mut simulation = Simulation::new(system, scene.state.clone(), Settings::default()).unwrap();
    while simulation.state().time() < LONG {
        let report = simulation.step().unwrap();
        assert!(report.max_relative_length_error <= 1e-10);
    }
}

#[test]
fn toml_and_json_say_the_same() {
    for shipped in shipped() {
        let tree: serde_json::Value = toml::from_str(shipped.text).unwrap();
        let text = serde_json::to_string_pretty(&tree).unwrap();
        let from_json = load(&text, "scene.json", Format::Json).unwrap_or_else(|errors| panic!("{errors}"));
        let from_toml = scene(shipped.name);
        let all = |scene: &Scene| {
            // The text itself differs.
            let Scene { name, description, system, state, settings, duration, expect, .. } = scene;
            let all = format!("{name} {description} {system:?} {state:?} {settings:?} {duration} {expect:?}");
            // The lines in which numbers stand differ, too.
            let mut pieces = all.split(" in line ");
            let first = pieces.next().unwrap_or_default().to_owned();
            pieces.fold(first, |all, piece| all + piece.trim_start_matches(|c: char| c.is_ascii_digit()))
        };
        assert_eq!(all(&from_json), all(&from_toml), "{}", shipped.name);
    }
}
