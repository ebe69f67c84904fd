//! Every kind of constraint, in one table of cases and one file for each question that is asked of all of them.

mod case;
mod cases;
mod closed_forms;
mod differences;
mod expressions;
mod motion;
mod refused;
mod rows;
mod singular;

use std::collections::BTreeSet;
use std::path::Path;

/// The kinds whose fields hold a number or a point that time may change, as the source of the engine declares them.
fn can_be_driven() -> BTreeSet<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/constraint");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    let source: String = files.map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(String::from).collect()
    };
    // Name of each public type, and the words up to the end of its declaration.
    let mut declared = Vec::new();
    for start in ["pub struct ", "pub enum ", "pub type "] {
        for rest in source.split(&format!("\n{start}")).skip(1) {
            let end = if start == "pub type " { ";" } else { "\n}" };
            let code: Vec<&str> =
                rest.split(end).next().unwrap().lines().filter(|line| !line.trim().starts_with("//")).collect();
            let mut words = words(&code.join("\n"));
            declared.push((words.remove(0), words));
        }
    }
    let mut driven = BTreeSet::from(["Driven".to_owned()]);
    loop {
        let more: Vec<String> = declared
            .iter()
            .filter(|(name, words)| !driven.contains(name) && words.iter().any(|word| driven.contains(word)))
            .map(|(name, _)| name.clone())
            .collect();
        if more.is_empty() {
            break;
        }
        driven.extend(more);
    }
    assert!(driven.contains("OnSphere") && !driven.contains("Distance"), "the search for fields found {driven:?}");
    driven
}
