//! A run tells the changes of its start and the reason of its end, and keeps its frames when it is cut short.

use crate::common::{Folder, PENDULUM};
use std::fs::{File, FileTimes};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime};

/// A dumb-bell whose ends start with velocities that no rod allows: along the rod the ends share their momentum, so
/// that the end of 1 kg keeps a quarter of its metre a second.
const DUMB_BELL: &str = r#"
schema = "qhat/1"
name = "Dumb-bell"
dimension = 2
step = { duration = 0.1 }
particles = [
    { id = "a", at = [0.0, 0.0], mass = 1.0, velocity = [1.0, 2.0] },
    { id = "b", at = [1.0, 0.0], mass = 3.0 },
]
constraints = [{ kind = "distance", between = ["a", "b"] }]
"#;

#[test]
fn velocities_that_the_start_changes_are_told() {
    let folder = Folder::with(&[("bell.toml", DUMB_BELL), ("bob.toml", PENDULUM)]);
    let ran = folder.qhat(&["run", "bell.toml"]).well();
    assert!(ran.stdout.contains("velocities changed by up to 7.50e-1 m/s"), "{}", ran.stdout);
    let summary = folder.qhat(&["run", "bell.toml", "--json"]).well().json();
    assert!((summary["start_velocity_changed"].as_f64().unwrap() - 0.75).abs() < 1e-12);
    let found = folder.qhat(&["check", "bell.toml", "--json"]).well().json();
    assert!((found["start_velocity_changed"].as_f64().unwrap() - 0.75).abs() < 1e-12);
    assert!(folder.qhat(&["check", "bell.toml"]).well().stdout.contains("velocities"));
    for command in ["run", "check"] {
        assert!(!folder.qhat(&[command, "bob.toml"]).well().stdout.contains("velocities"));
    }
}

#[test]
fn a_run_of_no_frames_is_refused() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    folder.qhat(&["run", "bob.toml", "--frames", "0"]).refused("a run of 0 frames simulates nothing");
}

#[test]
fn check_tells_what_run_would_refuse() {
    let odd = PENDULUM.replace("h = 0.01, duration = 0.5", "h = 0.01, duration = 0.505, integrator = \"rk4\"");
    let folder = Folder::with(&[("bob.toml", &odd)]);
    folder.qhat(&["run", "bob.toml"]).refused("takes steps of exactly h");
    let ran = folder.qhat(&["check", "bob.toml"]);
    assert_eq!(ran.code, 1, "{}", ran.stdout);
    assert!(ran.stdout.contains("would refuse it") && ran.stdout.contains("takes steps of exactly h"));
    let wrong = folder.qhat(&["check", "bob.toml", "--json"]).json();
    assert!(wrong["refused"].as_str().unwrap().contains("takes steps of exactly h"));
}

#[test]
fn the_most_substeps_can_be_set() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let accurate = ["--integrator", "dop853", "--tolerance", "1e-12", "--frames", "1"];
    let ran = folder.qhat(&[&["run", "bob.toml", "--max-substeps", "1"], &accurate[..]].concat());
    assert_eq!(ran.code, 1);
    assert!(ran.stderr.contains("more than 1 substeps"), "{}", ran.stderr);
    folder.qhat(&["run", "bob.toml", "--max-substeps", "0"]).refused("max_substeps");
}

/// Makes a temporary file look as if its process was killed an hour ago.
fn make_old(path: &Path) -> File {
    let file = File::create(path).unwrap();
    let hour_ago = SystemTime::now() - Duration::from_secs(3600);
    file.set_times(FileTimes::new().set_modified(hour_ago)).unwrap();
    file
}

#[test]
fn files_of_killed_runs_are_removed_and_those_of_others_stay() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    make_old(&folder.path(".qhat-dead.part"));
    let held = make_old(&folder.path(".qhat-held.part"));
    held.lock().unwrap();
    File::create(folder.path(".qhat-young.part")).unwrap();
    folder.qhat(&["run", "bob.toml", "-o", "bob.csv"]).well();
    let left: Vec<String> = folder.files().into_iter().filter(|name| name.ends_with(".part")).collect();
    assert_eq!(left, [".qhat-held.part", ".qhat-young.part"]);
}

/// A folder on a disk of 256 KiB; `None`, with a word, where the test may not mount a file system.
struct SmallDisk(PathBuf);

impl SmallDisk {
    fn new(path: PathBuf) -> Option<Self> {
        std::fs::create_dir_all(&path).unwrap();
        let mounted = Command::new("mount").args(["-t", "tmpfs", "-o", "size=256k", "tmpfs"]).arg(&path).status();
        if mounted.is_ok_and(|status| status.success()) {
            Some(SmallDisk(path))
        } else {
            eprintln!("not run: this user may not mount a file system");
            None
        }
    }

    fn files(&self) -> usize {
        std::fs::read_dir(&self.0).unwrap().count()
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

#[test]
fn a_full_disk_keeps_what_fits() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    // At 15 s the arrays of the NPZ fit, and the zip beside them does not.
    for (output, duration) in [("bob.csv", "100"), ("bob.npz", "100"), ("bob.npz", "15")] {
        let Some(disk) = SmallDisk::new(folder.path("disk")) else { return };
        let path = format!("disk/{output}");
        let ran = folder.qhat(&["run", "bob.toml", "--duration", duration, "-o", &path]);
        let bytes = std::fs::read(folder.path(&path)).unwrap_or_default();
        assert_eq!(ran.code, 2, "{}", ran.stderr);
        assert!(ran.stderr.starts_with("interrupted: cannot write"), "{}", ran.stderr);
        assert!(bytes.len() > 50_000, "{output}: {} bytes are kept", bytes.len());
        if output.ends_with("csv") {
            let text = String::from_utf8(bytes).unwrap();
            let columns = text.lines().next().unwrap().split(',').count();
            assert!(text.ends_with('\n') && text.lines().all(|line| line.split(',').count() == columns));
        } else {
            assert!(bytes.starts_with(b"PK"));
        }
        assert!(disk.files() <= 2, "no temporary file is left");
    }
}

/// A longer run that does not fit leaves the file that it goes on from, or its last checkpoint.
#[test]
fn a_full_disk_keeps_the_file_of_before() {
    let folder = Folder::with(&[("bob.toml", PENDULUM)]);
    let Some(disk) = SmallDisk::new(folder.path("disk")) else { return };
    let bytes = || std::fs::read(folder.path("disk/bob.npz")).unwrap();
    let kept = "the file of before is kept";
    folder.qhat(&["run", "bob.toml", "-o", "disk/bob.npz"]).well();
    let before = bytes();
    // At 15 s the arrays fit, and at 100 s they do not.
    for duration in ["15", "100"] {
        folder.qhat(&["run", "--from", "./disk/bob.npz", "-o", "disk/bob.npz", "--duration", duration]).refused(kept);
        assert!(bytes() == before);
    }
    std::fs::remove_file(folder.path("disk/bob.npz")).unwrap();
    let arguments = ["run", "bob.toml", "-o", "disk/bob.npz", "--duration", "15", "--checkpoint", "100frames"];
    folder.qhat(&arguments).refused(kept);
    assert_eq!(disk.files(), 1, "no temporary file is left");
    folder.qhat(&["run", "--from", "disk/bob.npz", "-o", "rest.npz"]).well();
    folder.qhat(&["run", "bob.toml", "-o", "whole.npz", "--duration", "15"]).well();
    let read = |name: &str| std::fs::read(folder.path(name)).unwrap();
    assert!(read("rest.npz") == read("whole.npz"));
}
