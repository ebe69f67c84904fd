//! A table of broken scenes and their exact messages: `broken/NAME.toml` or `.json`, and beside it the same name with
//! `.txt` behind. `QHAT_BLESS=1 cargo test -p qhat-scene --test broken` writes the messages anew; read the difference.

use qhat_scene::{Format, load};
use std::fs;
use std::path::{Path, PathBuf};

fn broken_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken");
    let files = fs::read_dir(folder).expect("the folder is part of the source").map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end != "txt")).collect();
    scenes.sort();
    scenes
}

#[test]
fn every_broken_scene_has_its_message() {
    let mut wrong = Vec::new();
    let scenes = broken_scenes();
    for path in &scenes {
        let name = path.file_name().unwrap().to_str().unwrap();
        let expected_path = path.with_file_name(format!("{name}.txt"));
        let said = match load(&fs::read_to_string(path).unwrap(), name, Format::from_path(name)) {
            Ok(scene) => panic!("{name} loads as {:?}", scene.name),
            Err(errors) => format!("{errors}\n"),
        };
        if std::env::var_os("QHAT_BLESS").is_some() {
            fs::write(&expected_path, &said).unwrap();
        }
        let expected = fs::read_to_string(&expected_path).unwrap_or_default();
        if said != expected {
            wrong.push(format!("{name}\nexpected:\n{expected}\nsaid:\n{said}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
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
