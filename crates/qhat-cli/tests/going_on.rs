//! `--from` and `--checkpoint`: a run that stopped goes on to the bytes of a run that did not.

use crate::common::{BREAKS, Folder, INFEASIBLE, PENDULUM, QHAT, npz};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Beads that fall on rough ground, on ropes, one of which breaks: contacts in every mode, impacts, events.
const HEAP: &str = r#"
schema = "qhat/1"
name = "Heap"
dimension = 2
step = { h = 0.01, duration = 3.0 }
parameters = { mu = 0.2 }
forces = { gravity = [0.0, -9.81] }
particles = [
    { id = "a", at = [0.0, 0.5], velocity = [1.0, 0.0] },
    { id = "b", at = [0.9, 0.7], velocity = [-0.5, 1.0] },
    { id = "c", at = [1.7, 1.2] },
]
constraints = [
    { kind = "half-space", id = "ground", restitution = 0.5, friction = "mu" },
    { kind = "rope", between = ["a", "b"], length = 1.0, restitution = 0.3 },
    { kind = "rope", between = ["b", "c"], length = 1.1, breaks_at = 60.0 },
]
"#;

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    std::fs::read(folder.path(name)).unwrap()
}

#[test]
fn a_longer_run_goes_on_from_a_complete_one() {
    let folder = Folder::with(&[("heap.toml", HEAP)]);
    let set = ["--set", "mu=0.35"];
    folder.qhat(&[&["run", "heap.toml", "-o", "whole.npz"], &set[..]].concat()).well();
    folder.qhat(&[&["run", "heap.toml", "-o", "part.npz", "--duration", "1"], &set[..]].concat()).well();
    // Without the scene beside it, in three pieces.
    std::fs::remove_file(folder.path("heap.toml")).unwrap();
    folder.qhat(&["run", "--from", "part.npz", "--duration", "1.5", "-o", "more.npz"]).well();
    folder.qhat(&["run", "--from", "more.npz", "--duration", "3"]).well();
    assert!(bytes(&folder, "more.npz") == bytes(&folder, "whole.npz"));
    folder.qhat(&["run", "--from", "more.npz"]).refused("it has reached t = 3 s; ask for more with --duration");
    folder.qhat(&["run", "--from", "more.npz", "--duration", "3.001"]).refused("is no whole number of its frames");
}

/// Frames of h have the same length whatever the duration, so the longer run has the same motion. Only the times of its
/// frames, i · duration / N, may differ in their last bit.
#[test]
fn a_run_of_any_duration_goes_on_with_the_same_motion() {
    let folder = Folder::with(&[("heap.toml", HEAP)]);
    folder.qhat(&["run", "heap.toml", "-o", "whole.npz", "--duration", "10"]).well();
    let whole = npz::read(&folder.path("whole.npz"));
    for short in ["0.7", "0.29", "2.3"] {
        folder.qhat(&["run", "heap.toml", "-o", "part.npz", "--duration", short, "--force"]).well();
        folder.qhat(&["run", "--from", "part.npz", "--duration", "10"]).well();
        let longer = npz::read(&folder.path("part.npz"));
        for name in ["positions", "velocities", "multipliers"] {
            assert!(longer[name] == whole[name], "{name} from {short} s");
        }
    }
}

#[test]
#[cfg(unix)]
fn an_interrupted_run_goes_on() {
    let folder = Folder::with(&[("heap.toml", HEAP)]);
    let run = ["run", "heap.toml", "--quiet", "--frames", "6000", "--duration", "60"];
    folder.qhat(&[&run[..], &["-o", "whole.npz"]].concat()).well();
    let before = folder.files();
    let mut command = Command::new(QHAT);
    command.current_dir(folder.root()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.args(run).args(["-o", "part.npz"]).spawn().unwrap();
    // The command listens for Ctrl-C before it opens files.
    while folder.files() == before {
        std::thread::yield_now();
    }
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    child.wait().unwrap();
    let ended = folder.qhat(&["run", "--from", "part.npz", "--quiet"]);
    // A fast machine may have been through.
    assert!(ended.code == 0 || ended.stderr.contains("ask for more with --duration"), "{ended:?}");
    assert!(bytes(&folder, "part.npz") == bytes(&folder, "whole.npz"));
}

#[test]
fn a_summary_goes_on_too() {
    let folder = Folder::with(&[("heap.toml", HEAP)]);
    let summary = |arguments: &[&str]| {
        let mut found = folder.qhat(arguments).well().json();
        let table = found.as_object_mut().unwrap();
        for key in ["wall_seconds", "cpu_seconds", "output"] {
            table.remove(key);
        }
        found
    };
    let whole = summary(&["run", "heap.toml", "-o", "whole.npz", "--json"]);
    folder.qhat(&["run", "heap.toml", "-o", "part.npz", "--duration", "1"]).well();
    assert_eq!(summary(&["run", "--from", "part.npz", "--duration", "3", "--json"]), whole);
}

/// Kills the run with SIGKILL at several moments, and goes on from what is there.
#[test]
#[cfg(unix)]
fn long_a_killed_run_goes_on_from_its_checkpoint() {
    let folder = Folder::with(&[("heap.toml", HEAP)]);
    let run = ["run", "heap.toml", "--quiet", "--frames", "6000", "--duration", "60"];
    folder.qhat(&[&run[..], &["-o", "whole.npz"]].concat()).well();
    let whole = bytes(&folder, "whole.npz");
    for (interval, moments) in [("300frames", [30, 90, 170]), ("0.05s", [60, 120, 250])] {
        let _ = std::fs::remove_file(folder.path("cut.npz"));
        for milliseconds in moments {
            let mut command = Command::new(QHAT);
            command.current_dir(folder.root()).stdout(Stdio::null()).stderr(Stdio::null());
            if folder.path("cut.npz").exists() {
                command.args(["run", "--from", "cut.npz", "--quiet", "--checkpoint", interval]);
            } else {
                command.args(run).args(["-o", "cut.npz", "--checkpoint", interval]);
            }
            let mut child = command.spawn().unwrap();
            sleep(Duration::from_millis(milliseconds));
            child.kill().unwrap();
            child.wait().unwrap();
        }
        if folder.path("cut.npz").exists() {
            let ended = folder.qhat(&["run", "--from", "cut.npz", "--quiet"]);
            assert!(ended.code == 0 || ended.stderr.contains("ask for more with --duration"), "{ended:?}");
        } else {
            // A slow machine was killed before its first checkpoint each time.
            folder.qhat(&[&run[..], &["-o", "cut.npz", "--checkpoint", interval]].concat()).well();
        }
        assert!(bytes(&folder, "cut.npz") == whole, "{interval}");
    }
}

#[test]
fn what_cannot_go_on_is_refused_in_words() {
    let folder = Folder::with(&[("bob.toml", PENDULUM), ("other.toml", BREAKS), ("torn.toml", INFEASIBLE)]);
    folder.qhat(&["run", "bob.toml", "-o", "bob.npz"]).well();
    let longer = ["--duration", "1"];
    let from = |name: &str, more: &[&str]| folder.qhat(&[&["run", "--from", name], &longer[..], more].concat());
    from("none.npz", &[]).refused("cannot read `none.npz`");
    from("bob.toml", &[]).refused("`bob.toml` is no trajectory that `qhat run -o run.npz` writes");
    folder.qhat(&["run", "other.toml", "--from", "bob.npz"]).refused("computed from another text than that of");
    folder.qhat(&["run", "torn.toml", "-o", "torn.npz"]);
    from("torn.npz", &[]).refused("its run ended with an error, from which nothing can go on");
    from("bob.npz", &["--h", "0.1"]).refused("cannot be used with");
    from("bob.npz", &["-o", "bob.csv"]).refused("a run can go on from a file in .npz alone");
    folder.qhat(&["run", "bob.toml", "--checkpoint", "5s"]).refused("a run can go on from a file in .npz alone");
    folder.qhat(&["run", "bob.toml", "-o", "b.npz", "--checkpoint", "0s"]).refused("written as in 30s or 100frames");
    folder.qhat(&["run", "bob.toml", "-o", "b.npz", "--checkpoint", "often"]).refused("written as in 30s or 100frames");

    // A file that is cut, and one with a changed byte in its snapshot.
    let whole = bytes(&folder, "bob.npz");
    std::fs::write(folder.path("cut.npz"), &whole[..whole.len() / 2]).unwrap();
    from("cut.npz", &[]).refused("`cut.npz` is no trajectory that `qhat run -o run.npz` writes");
    let place = whole.windows(8).position(|bytes| bytes == b"qhatrun\x02").unwrap();
    let mut changed = whole.clone();
    changed[place + 40] ^= 1;
    std::fs::write(folder.path("changed.npz"), changed).unwrap();
    from("changed.npz", &[]).refused("cannot read `changed.npz`");
    // Snapshots that differ in an archive whose checksums are right.
    let with = |offset: usize, byte: u8| {
        let change = |snapshot: &mut Vec<u8>| {
            let place = snapshot.windows(7).position(|bytes| bytes == b"qhatrun").unwrap();
            snapshot[place + offset] = byte;
        };
        npz::rewrite(&folder.path("bob.npz"), &folder.path("changed.npz"), "snapshot", &change);
        from("changed.npz", &[])
    };
    with(7, 9).refused("cannot go on from `changed.npz`: its snapshot has version 9, and this qhat reads version 2");
    with(0, b'Q').refused("cannot go on from `changed.npz`: its snapshot is damaged");
    assert!(bytes(&folder, "bob.npz") == whole);
}
