//! `--from` and `--checkpoint`: a run that stopped goes on to the bytes of a run that did not.

use crate::common::{BREAKS, Folder, INFEASIBLE, PENDULUM, QHAT};
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
    folder.qhat(&["run", "--from", "more.npz"]).refused("its run of 3 s is complete; ask for a longer one");
    folder.qhat(&["run", "--from", "more.npz", "--duration", "3.001"]).refused("no whole number of its frames");
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
            assert!(ended.code == 0 || ended.stderr.contains("is complete"), "{ended:?}");
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
    let place = whole.windows(8).position(|bytes| bytes == b"qhatrun\x01").unwrap();
    let with = |offset: usize, byte: u8| {
        let mut changed = whole.clone();
        changed[place + offset] = byte;
        std::fs::write(folder.path("changed.npz"), changed).unwrap();
    };
    with(7, 9);
    from("changed.npz", &[]).refused("changed.npz");
    with(40, whole[place + 40] ^ 1);
    from("changed.npz", &[]).refused("changed.npz");
    assert!(bytes(&folder, "bob.npz") == whole);
}
