//! The test of the test: faults planted in a copy of the engine must be found.
//!
//! A feature of the crate qhat could plant them as well, but `--all-features` would turn it on, and the engine would
//! carry code that is wrong on purpose. So this test copies the crates into the target folder, changes a few lines of
//! the copy, and builds that. One build has all faults; a variable of the environment chooses one.

use qhat_differ::compare::{compare, read};
use qhat_differ::generate::framework;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A fault of the engine, and seeds that must each find it.
struct Fault {
    name: &'static str,
    file: &'static str,
    /// The text that is replaced, which the file has once.
    right: &'static str,
    /// The text with the fault.
    wrong: &'static str,
    /// Seeds of different shapes whose runs end at once in spite of the fault.
    seeds: &'static [u64],
}

/// The faults. A wrong γ of the lanes of chains is not among them: the rule of acceptance shortens substeps whose
/// projection moves too far, until the motion is right, and only the time of the run tells.
const FAULTS: [Fault; 3] = [
    Fault {
        name: "the sign of γ",
        file: "crates/qhat/src/multiplier/rhs.rs",
        right: "self.bias[i] = -rows.gamma[i];",
        wrong: "self.bias[i] = if crate::planted(\"the sign of γ\") { rows.gamma[i] } else { -rows.gamma[i] };",
        // Springs, and cranks through their flat position. Under most others the run takes longer than 20 s, because of
        // the same rule of acceptance.
        seeds: &[10, 11],
    },
    Fault {
        name: "a dropped row",
        file: "crates/qhat/src/multiplier/active.rs",
        right: "        self.constrain_all(system, motion);\n",
        wrong: "        self.constrain_all(system, motion);\n        \
                if crate::planted(\"a dropped row\") {\n            \
                self.inactive = (0..self.rows.C.len()).map(|row| row == 0).collect();\n        }\n",
        // A tree, cranks, and cranks through their flat position.
        seeds: &[0, 3, 11],
    },
    Fault {
        name: "the slope of cos",
        file: "crates/qhat/src/expression/operation.rs",
        right: "Cosine => [-libm::sin(a), 0.0],",
        wrong: "Cosine => [if crate::planted(\"the slope of cos\") { libm::sin(a) } else { -libm::sin(a) }, 0.0],",
        // A constraint and two potentials with a cosine.
        seeds: &[34, 43, 61],
    },
];

/// The function that the faults ask.
const PLANTED: &str = "
pub(crate) fn planted(fault: &str) -> bool {
    static CHOSEN: std::sync::OnceLock<Option<String>> = std::sync::OnceLock::new();
    CHOSEN.get_or_init(|| std::env::var(\"QHAT_PLANTED\").ok()).as_deref() == Some(fault)
}
";

/// The longest time of a run. Without a fault, and with one, each seed above takes up to 0.2 s in a debug build.
const LONGEST: Duration = Duration::from_secs(60);

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Writes a file where its content differs, so that cargo builds again only what changed.
fn write(path: &Path, content: &[u8]) {
    if fs::read(path).is_ok_and(|before| before == content) {
        return;
    }
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, content).unwrap();
}

/// Copies a folder, with the faults planted in the files that have one.
fn copy(place: &Path, to: &Path) {
    for entry in fs::read_dir(root().join(place)).unwrap() {
        let place = place.join(entry.unwrap().file_name());
        if root().join(&place).is_dir() {
            copy(&place, to);
            continue;
        }
        let mut content = fs::read(root().join(&place)).unwrap();
        for Fault { name, file, right, wrong, .. } in FAULTS.iter().filter(|fault| Path::new(fault.file) == place) {
            let text = String::from_utf8(content).unwrap();
            assert_eq!(text.matches(right).count(), 1, "{name}: {file} does not have `{right}` once");
            content = text.replace(right, wrong).into_bytes();
        }
        if place == Path::new("crates/qhat/src/lib.rs") {
            content.extend(PLANTED.as_bytes());
        }
        write(&to.join(&place), &content);
    }
}

/// The command of this crate, built from the copy.
fn build(target: &Path) -> PathBuf {
    let copied = target.join("workspace");
    for place in ["crates/qhat", "crates/qhat-scene", "crates/qhat-differ", "scenes"] {
        copy(Path::new(place), &copied);
    }
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let (before, rest) = manifest.split_once("members = [").unwrap();
    let (_, after) = rest.split_once(']').unwrap();
    let members = "\"crates/qhat\", \"crates/qhat-scene\", \"crates/qhat-differ\"";
    write(&copied.join("Cargo.toml"), format!("{before}members = [{members}]{after}").as_bytes());
    // The versions of today, and the file that the manifest of the crate qhat names.
    for file in ["Cargo.lock", "README.md"] {
        write(&copied.join(file), &fs::read(root().join(file)).unwrap());
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline", "--package", "qhat-differ"]).current_dir(&copied);
    // Neither a debugger nor a next change of one file needs this build, and both would take longer than it.
    cargo.env("CARGO_PROFILE_DEV_DEBUG", "0").env("CARGO_INCREMENTAL", "0");
    let built = cargo.env("CARGO_TARGET_DIR", target).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    target.join("debug").join(format!("qhat-differ{}", std::env::consts::EXE_SUFFIX))
}

/// The exit status of a seed under a fault, `None` where the run takes too long, and its output.
fn run(command: &Path, fault: &str, seed: u64) -> (Option<i32>, String) {
    let said = command.with_extension("said");
    let mut run = Command::new(command);
    run.args(["seed", &seed.to_string()]).env("QHAT_PLANTED", fault).stdout(fs::File::create(&said).unwrap());
    let (start, mut child) = (Instant::now(), run.spawn().unwrap());
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status.code();
        }
        if start.elapsed() > LONGEST {
            child.kill().unwrap();
            child.wait().unwrap();
            break None;
        }
        sleep(Duration::from_millis(10));
    };
    (status, fs::read_to_string(said).unwrap())
}

#[test]
#[ignore = "builds a second engine, for up to three minutes on two cores: `make fuzz` runs it"]
fn long_planted_faults_are_found() {
    let target = std::env::current_exe().unwrap().ancestors().nth(3).unwrap().join("planted");
    let command = build(&target);
    for fault in &FAULTS {
        for &seed in fault.seeds {
            let (status, said) = run(&command, "", seed);
            assert_eq!(status, Some(0), "without a fault:\n{said}");
            let (status, said) = run(&command, fault.name, seed);
            assert_eq!(status, Some(1), "{} was not found:\n{said}", fault.name);
        }
    }
}

/// The same within a test run: a scene that says a little else than the framework of its seed, a row of cranks under a
/// spring. Each change is 1e-6 or less, or one row.
#[test]
fn changes_of_a_scene_are_found() {
    let framework = framework(3);
    assert!(compare(&framework, &read).findings.is_empty(), "without a change");
    for (what, right, wrong) in [
        ("a row", r#"{"kind" = "distance", "between" = ["p0", "p1"], "length" = 1.0949176592708951},"#, ""),
        ("gravity", r#""gravity" = [0.0, 12.0506651"#, r#""gravity" = [0.0, 12.0506652"#),
        ("a length", r#""length" = 1.056205"#, r#""length" = 1.056206"#),
        ("a stiffness", r#""stiffness" = 2117.4416"#, r#""stiffness" = 2117.4417"#),
    ] {
        let changed = |text: &str, format| {
            assert_eq!(text.matches(right).count(), 1, "{what}: the scene does not have `{right}` once:\n{text}");
            read(&text.replace(right, wrong), format)
        };
        assert!(!compare(&framework, &changed).findings.is_empty(), "the change of {what} was not found");
    }
}
