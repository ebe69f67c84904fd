//! Scenes, schema, completions, help; and every command in the guide.

use crate::common::{Folder, QHAT};
use std::process::{Command, Stdio};

#[test]
fn scenes_are_listed_and_printed() {
    let folder = Folder::new();
    let list = folder.qhat(&["scenes", "--json"]).well().json();
    let list = list.as_array().unwrap();
    let said = folder.qhat(&["scenes"]).well().stdout;
    for scene in list {
        let name = scene["name"].as_str().unwrap();
        for key in ["name", "title", "description"] {
            assert!(said.contains(scene[key].as_str().unwrap()), "{scene}");
        }
        let text = folder.qhat(&["scenes", name]).well().stdout;
        assert!(text.contains("schema = \"qhat/1\""), "{name}");
        // The printed scene can be read again.
        folder.qhat_reading(&text, &["check", "-"]).well();
    }
    assert!(list.iter().any(|scene| scene["name"] == "pendulum"));
}

#[test]
fn schema_is_json() {
    let schema = Folder::new().qhat(&["schema"]).well().json();
    assert!(schema["properties"]["particles"].is_object());
}

#[test]
fn completions_for_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = Folder::new().qhat(&["completions", shell]).well().stdout;
        assert!(script.contains("qhat") && script.contains("integrator"), "{shell}");
    }
}

#[test]
fn help_says_the_exit_codes_and_version_the_version() {
    let help = Folder::new().qhat(&["--help"]).well().stdout;
    assert!(help.contains("Exit codes:") && help.contains("completions"), "{help}");
    let version = Folder::new().qhat(&["--version"]).well().stdout;
    assert_eq!(version, format!("qhat {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_reader_that_went_away_is_no_error() {
    for arguments in
        [&["schema"][..], &["scenes"], &["completions", "zsh"], &["check", "pendulum"], &["run", "pendulum", "--json"]]
    {
        let mut command = Command::new(QHAT);
        let mut child = command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            (output.status.code(), String::from_utf8(output.stderr).unwrap()),
            (Some(0), String::new()),
            "{arguments:?}"
        );
    }
}

#[test]
fn no_colours_reach_a_pipe() {
    let folder = Folder::new();
    for arguments in [&["--help"][..], &["run", "nothing"], &["run", "--h"], &["run", "pendulum", "--duration", "0.1"]]
    {
        let ran = folder.qhat(arguments);
        assert!(!ran.stdout.contains('\u{1b}') && !ran.stderr.contains('\u{1b}'), "{arguments:?}");
    }
}

/// The lines of a document that begin with a command, indented as code.
#[cfg(unix)]
fn commands(document: &str, start: &str) -> Vec<String> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(document);
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().filter_map(|line| line.strip_prefix("    ")?.strip_prefix(start));
    // `qhat play` does not end by itself; tests/play.rs tests it.
    lines.filter(|line| !line.starts_with("play")).map(|line| format!("qhat {line}")).collect()
}

#[test]
#[cfg(unix)]
fn every_command_in_the_documents_runs() {
    for (document, start) in [("docs/command.md", "qhat "), ("README.md", "target/release/qhat ")] {
        let folder = Folder::new();
        let lines = commands(document, start);
        assert!(lines.len() >= 3, "{document} has commands");
        let qhat = format!("qhat() {{ '{QHAT}' \"$@\"; }}");
        for line in lines {
            // The commands run one after the other in one folder, because later lines use files of earlier lines.
            let script = format!("{qhat}\n{line}");
            let output = Command::new("sh").args(["-c", &script]).current_dir(folder.root()).output().unwrap();
            assert_eq!(
                output.status.code(),
                Some(0),
                "{document}: {line}: {}",
                String::from_utf8_lossy(&output.stderr)
            );
        }
    }
}

#[test]
fn every_key_of_a_summary_stands_in_the_guide() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/command.md");
    let guide = std::fs::read_to_string(path).unwrap();
    let folder = Folder::new();
    for arguments in [&["run", "pendulum", "--duration", "0.1", "--json"][..], &["check", "pendulum", "--json"]] {
        let summary = folder.qhat(arguments).well().json();
        let keys = summary.as_object().unwrap();
        assert!(keys.len() > 10, "{arguments:?}: {summary}");
        let missing: Vec<_> = keys.keys().filter(|key| !guide.contains(&format!("`{key}`"))).collect();
        assert!(missing.is_empty(), "docs/command.md lacks {missing:?} of {arguments:?}");
    }
}

/// Whether a line of a document occurs in the output of a command; `…` stands for text that differs from run to run.
#[cfg(unix)]
fn is_said(shown: &str, said: &str) -> bool {
    said.lines().any(|line| {
        let mut rest = Some(line);
        for (k, piece) in shown.split('…').enumerate() {
            rest = match rest {
                Some(rest) if k == 0 => rest.strip_prefix(piece),
                Some(rest) => rest.split_once(piece).map(|(_, after)| after),
                None => None,
            };
        }
        rest.is_some_and(|rest| rest.is_empty() || shown.ends_with('…'))
    })
}

#[test]
#[cfg(unix)]
fn output_in_the_readme_is_what_the_command_prints() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md");
    let text = std::fs::read_to_string(path).unwrap();
    let folder = Folder::new();
    let (mut said, mut shown) = (String::new(), 0);
    for line in text.lines().map(|line| line.strip_prefix("    ").unwrap_or_default()) {
        if let Some(arguments) = line.strip_prefix("target/release/qhat ") {
            let arguments: Vec<&str> = arguments.split_whitespace().take_while(|word| *word != "#").collect();
            said = if arguments[0] == "play" { String::new() } else { folder.qhat(&arguments).stdout };
        } else if !line.is_empty() && !said.is_empty() {
            shown += 1;
            assert!(is_said(line, &said), "README shows this line:\n{line}\nand the command prints:\n{said}");
        } else {
            said.clear();
        }
    }
    assert!(shown > 10, "the search for output found only {shown} lines");
}
