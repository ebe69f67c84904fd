//! The test of the test: faults planted in a copy of the engine must be found.
//!
//! A feature of the crate qhat could plant them as well, but `--all-features` would turn it on, and the engine would
//! carry code that is wrong on purpose. So this test copies the crates into the target folder, changes a few lines of
//! the copy, and builds that. One build has all faults; a variable of the environment chooses one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A fault of the lanes of chains is not among them: the rule of acceptance shortens substeps whose projection moves
/// too far, until the motion is right, and only the time of the run tells.
///
/// A fault: its name, the file, the text that is replaced, the text with the fault.
const FAULTS: [(&str, &str, &str, &str); 3] = [
    (
        "the sign of γ",
        "crates/qhat/src/multiplier/rhs.rs",
        "self.bias[i] = -rows.gamma[i];",
        "self.bias[i] = if crate::planted(\"the sign of γ\") { rows.gamma[i] } else { -rows.gamma[i] };",
    ),
    (
        "a dropped row",
        "crates/qhat/src/multiplier/active.rs",
        "        self.constrain_all(system, motion);\n",
        "        self.constrain_all(system, motion);\n        \
         if crate::planted(\"a dropped row\") {\n            \
         self.inactive = (0..self.rows.C.len()).map(|row| row == 0).collect();\n        }\n",
    ),
    (
        "the slope of cos",
        "crates/qhat/src/expression/operation.rs",
        "Cosine => [-libm::sin(a), 0.0],",
        "Cosine => [if crate::planted(\"the slope of cos\") { libm::sin(a) } else { -libm::sin(a) }, 0.0],",
    ),
];

/// The function that the faults ask.
const PLANTED: &str = "
pub(crate) fn planted(fault: &str) -> bool {
    static CHOSEN: std::sync::OnceLock<Option<String>> = std::sync::OnceLock::new();
    CHOSEN.get_or_init(|| std::env::var(\"QHAT_PLANTED\").ok()).as_deref() == Some(fault)
}
";

/// The seeds that must show a fault: every family once.
const SEEDS: &str = "13";

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
        for (fault, file, right, wrong) in FAULTS.iter().filter(|fault| Path::new(fault.1) == place) {
            let text = String::from_utf8(content).unwrap();
            assert_eq!(text.matches(right).count(), 1, "{fault}: {file} does not have `{right}` once");
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
    if !copied.join("Cargo.lock").exists() {
        write(&copied.join("Cargo.lock"), &fs::read(root().join("Cargo.lock")).unwrap());
    }
    write(&copied.join("README.md"), &fs::read(root().join("README.md")).unwrap());
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline", "--package", "qhat-differ"]).current_dir(&copied);
    // Neither a debugger nor a next change of one file needs this build, and both would take longer than it.
    cargo.env("CARGO_PROFILE_DEV_DEBUG", "0").env("CARGO_INCREMENTAL", "0");
    let built = cargo.env("CARGO_TARGET_DIR", target).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    target.join("debug").join(format!("qhat-differ{}", std::env::consts::EXE_SUFFIX))
}

#[test]
#[ignore = "builds a second engine and follows wrong motions, for minutes: `make fuzz` runs it"]
fn long_planted_faults_are_found() {
    let target = std::env::current_exe().unwrap().ancestors().nth(3).unwrap().join("planted");
    let command = build(&target);
    let run = |fault: &str| {
        let mut run = Command::new(&command);
        run.args(["seeds", "0", SEEDS]).env("QHAT_PLANTED", fault).output().unwrap()
    };
    let said = |output: &std::process::Output| String::from_utf8_lossy(&output.stdout).into_owned();
    let clean = run("");
    assert!(clean.status.success(), "without a fault:\n{}", said(&clean));
    for (fault, ..) in FAULTS {
        let output = run(fault);
        assert_eq!(output.status.code(), Some(1), "{fault} was not found:\n{}", said(&output));
    }
}
