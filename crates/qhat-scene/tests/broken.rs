//! A table of broken scenes and their exact messages: `broken/NAME.toml` or `.json`, and beside it the same name with
//! `.txt` appended. `{every kind of constraint}` in a message stands for the list in the schema, so that a new kind
//! changes no message. `UPDATE=1 cargo test --package qhat-scene --test all broken` writes the messages anew; read the
//! diff before you commit it.

use qhat_scene::{Format, json_schema, load};
use std::fs;
use std::path::{Path, PathBuf};

fn broken_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken");
    let files = fs::read_dir(folder).expect("the folder is part of the source").map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end != "txt")).collect();
    scenes.sort();
    scenes
}

const EVERY_KIND: &str = "{every kind of constraint}";

/// The kinds of constraints in the order of the schema, as messages list them: `a`, `b` or `c`.
fn every_kind() -> String {
    let schema = json_schema();
    let kinds: Vec<String> = schema["$defs"]["Constraint"]["oneOf"]
        .as_array()
        .expect("a constraint is one of its kinds")
        .iter()
        .map(|kind| format!("`{}`", kind["properties"]["kind"]["const"].as_str().expect("each kind has a name")))
        .collect();
    let (last, others) = kinds.split_last().expect("there are kinds");
    assert!(others.len() >= 20, "{kinds:?}");
    format!("{} or {last}", others.join(", "))
}

#[test]
fn every_broken_scene_has_its_message() {
    let every_kind = every_kind();
    let mut wrong = Vec::new();
    let scenes = broken_scenes();
    for path in &scenes {
        let name = path.file_name().unwrap().to_str().unwrap();
        let expected_path = path.with_file_name(format!("{name}.txt"));
        let said = match load(&fs::read_to_string(path).unwrap(), name, Format::from_path(name)) {
            Ok(scene) => panic!("{name} loads as {:?}", scene.name),
            Err(errors) => format!("{errors}\n"),
        };
        if std::env::var_os("UPDATE").is_some() {
            fs::write(&expected_path, said.replace(&every_kind, EVERY_KIND)).unwrap();
        }
        let expected = fs::read_to_string(&expected_path).unwrap_or_default().replace(EVERY_KIND, &every_kind);
        if said != expected {
            wrong.push(format!("{name}\nexpected:\n{expected}\nsaid:\n{said}"));
        }
    }
    let how = "if that is meant: UPDATE=1 cargo test --package qhat-scene --test all broken";
    assert!(wrong.is_empty(), "{}\n{how}", wrong.join("\n"));
    assert!(scenes.len() >= 40, "{} broken scenes", scenes.len());
}

#[test]
fn no_message_is_without_its_scene() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken");
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "txt") {
            assert!(path.with_extension("").exists(), "{} has no scene", path.display());
        }
    }
}

#[test]
fn every_error_points_into_its_text() {
    for path in broken_scenes() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let errors = load(&text, name, Format::from_path(name)).unwrap_err();
        assert!(!errors.errors.is_empty(), "{name}");
        for error in errors.errors {
            assert!(text.get(error.span.clone()).is_some(), "{name}: {:?}", error.span);
            let line = text[..error.span.start].matches('\n').count() + 1;
            assert_eq!(error.line, line, "{name}");
        }
    }
}
