//! Input that the command refuses: always with exit code 2, a message that says what to do, and no change of any file.

use crate::common::{Folder, PENDULUM, QHAT, Ran};

#[test]
fn an_output_that_exists_is_not_overwritten_without_force() {
    let folder = Folder::with(&[("bob.toml", PENDULUM), ("bob.csv", "mine"), ("bob.npz", "mine")]);
    for output in ["bob.csv", "bob.npz"] {
        folder.qhat(&["run", "bob.toml", "-o", output]).refused("exists; nothing was written. Use --force");
        assert_eq!(folder.read(output), "mine");
        folder.qhat(&["run", "bob.toml", "-o", output, "--force"]).well();
        assert_ne!(std::fs::read(folder.path(output)).unwrap(), b"mine");
    }
    assert_eq!(folder.files(), ["bob.csv", "bob.csv.json", "bob.npz", "bob.toml"], "nothing temporary is left");
}

#[test]
fn the_origin_beside_a_csv_is_not_overwritten_either() {
    let folder = Folder::with(&[("bob.toml", PENDULUM), ("bob.csv.json", "mine")]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.csv"]).refused("`bob.csv.json` exists");
    assert_eq!(folder.files(), ["bob.csv.json", "bob.toml"]);
    assert_eq!(folder.read("bob.csv.json"), "mine");
}

#[test]
fn a_broken_scene_says_where_and_leaves_the_output_alone() {
    let broken = PENDULUM.replace("mass = 2.0", "mass = -2.0");
    let folder = Folder::with(&[("bob.toml", &broken), ("bob.npz", "mine")]);
    let line = 1 + broken[..broken.find("-2.0").unwrap()].matches('\n').count();
    for arguments in [&["run", "bob.toml", "-o", "bob.npz", "--force"][..], &["check", "bob.toml"]] {
        let ran = folder.qhat(arguments).refused(&format!("bob.toml:{line}:"));
        assert_eq!(ran.stdout, "");
    }
    assert_eq!(folder.read("bob.npz"), "mine");
    assert_eq!(folder.files(), ["bob.npz", "bob.toml"]);
}

#[test]
fn bytes_that_are_no_text_are_refused_with_their_place() {
    let folder = Folder::new();
    std::fs::write(folder.path("scene.toml"), b"name = \"\xff\"").unwrap();
    folder.qhat(&["run", "scene.toml"]).refused("scene.toml:1:9: ");
}

#[test]
fn a_scene_that_is_not_there_is_told_from_the_shipped_ones() {
    let folder = Folder::new();
    let ran = folder.qhat(&["run", "pendulumm"]).refused("there is no file `pendulumm`");
    assert!(ran.stderr.contains("pendulum, "), "names them: {}", ran.stderr);
    folder.qhat(&["run", "."]).refused("`.` is a folder, not a scene file");
    folder.qhat(&["scenes", "nothing"]).refused("no scene `nothing` comes with qhat");
    folder.qhat(&["run", "-"]).refused("stdin:1:1: the scene is empty");
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_run() {
    let folder = Folder::new();
    // A run of this length does not end before the test does.
    let endless = |output: &str| folder.qhat(&["run", "pendulum", "--duration", "1e6", "-o", output]);
    endless("bob.txt").refused("end the name in .npz (NumPy arrays) or .csv");
    endless("bob").refused("end the name in .npz");
    endless("nowhere/bob.npz").refused("there is no folder `nowhere`");
    std::fs::create_dir(folder.path("full.npz")).unwrap();
    endless("full.npz").refused("`full.npz` is a folder");
    assert_eq!(folder.files(), ["full.npz"]);
}

#[test]
fn numbers_out_of_range_are_refused() {
    let folder = Folder::new();
    let run = |arguments: &[&str]| folder.qhat(&[&["run", "pendulum"], arguments].concat());
    run(&["--h", "0"]).refused("h must be finite and positive, but is 0");
    run(&["--h", "-0.1"]).refused("h must be finite and positive");
    run(&["--h", "nan"]).refused("h must be finite and positive");
    run(&["--duration", "-1"]).refused("the duration must be positive and finite, but is -1 s");
    run(&["--duration", "inf"]).refused("the duration must be positive and finite");
    run(&["--frames", "-1"]).refused("invalid value '-1' for '--frames <N>'");
    run(&["--duration", "1e300"]).refused("ask for fewer with --frames");
    run(&["--frames", "18446744073709551615"]).refused("ask for fewer with --frames");
    run(&["--tolerance", "0"]).refused("tolerance must be");
    run(&["--tolerance", "nan"]).refused("tolerance must be");
    run(&["--integrator", "magic"]).refused("possible values: euler");
    run(&["--force"]).refused("--output");
    folder.qhat(&[]).refused("Usage: qhat");
    folder.qhat(&["dance"]).refused("unrecognized subcommand");
}

#[test]
fn what_a_scene_says_moves_nothing_on_the_terminal() {
    let hostile = PENDULUM.replace("A bob", "A \\u001b[2Jbob\\u202e");
    let said = Folder::new().qhat_reading(&hostile, &["run", "-"]).stdout;
    assert!(said.chars().all(|character| character == '\n' || !character.is_control()), "{said:?}");
    assert!(!said.contains('\u{202e}'), "{said:?}");
}

#[test]
#[cfg(unix)]
fn an_interrupted_run_keeps_and_marks_what_was_reached() {
    use std::process::{Command, Stdio};

    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let mut command = Command::new(QHAT);
    command.current_dir(folder.root()).stdout(Stdio::null()).stderr(Stdio::piped());
    let child = command.args(["run", "bob.toml", "--duration", "1e5", "-o", "bob.csv"]).spawn().unwrap();
    // The command listens for Ctrl-C before it opens files, so the test can wait for the first file.
    while folder.files() == ["bob.toml"] {
        std::thread::yield_now();
    }
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success());
    let ran = Ran::new(child.wait_with_output().unwrap());
    assert_eq!(ran.code, 130, "{ran:?}");
    assert!(folder.read("bob.csv.json").contains(r#""status":"interrupted""#));
    assert!(folder.read("bob.csv").lines().count() >= 2, "a header and the start");
    assert_eq!(folder.files(), ["bob.csv", "bob.csv.json", "bob.toml"], "nothing temporary is left");
}
