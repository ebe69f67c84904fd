//! Imports of the engine go down the floors that ARCHITECTURE.md lists, never up.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The modules of the table of floors, from the ground up. A module may import those of rows above its own, so the
/// numbers of floors must not fall from row to row.
fn floors() -> Vec<String> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let (_, table) = text.split_once("| floor | module |").expect("ARCHITECTURE.md has a table of floors");
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let cells = rows.map(|row| row.split('|').map(str::trim).collect::<Vec<_>>());
    let (numbers, modules): (Vec<usize>, Vec<String>) =
        cells.map(|cells| (cells[1].parse::<usize>().unwrap(), cells[2].trim_matches('`').to_owned())).unzip();
    assert!(numbers.is_sorted(), "the floors of ARCHITECTURE.md are not in order: {numbers:?}");
    modules
}

/// Every source file of the engine below a folder, without the tests.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") && !path.ends_with("tests.rs") {
            found.push(path);
        }
    }
}

/// Every name that follows `crate::` in the code of a file: modules, and names of the root.
fn imported(source: &str) -> BTreeSet<String> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let code: String = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let paths = code.match_indices("crate::").map(|(place, prefix)| &code[place + prefix.len()..]);
    // This test would not see the modules in `use crate::{a, b}`.
    paths.map(|path| if path.starts_with('{') { "{".to_owned() } else { word(path) }).collect()
}

#[test]
fn imports_go_down_the_floors() {
    let floors = floors();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&folder, &mut files);
    files.retain(|path| !path.ends_with("lib.rs"));
    assert!(files.len() > 100, "the walk through the engine found only {} files", files.len());
    let mut wrong = Vec::new();
    let mut met = BTreeSet::new();
    for path in &files {
        let place = path.strip_prefix(&folder).unwrap();
        let module = place.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs").to_owned();
        let floor = |name: &str| floors.iter().position(|other| other == name);
        let shown = place.display();
        match floor(&module) {
            None => wrong.push(format!("{shown}: `{module}` is not in the table of floors")),
            Some(own) => {
                for name in imported(&fs::read_to_string(path).unwrap()).into_iter().filter(|name| *name != module) {
                    match floor(&name) {
                        Some(other) if other < own => {}
                        Some(_) => wrong.push(format!("{shown}: `{module}` imports `{name}`, which lies above it")),
                        None => wrong.push(format!("{shown}: `crate::{name}` is no module of the table of floors")),
                    }
                }
            }
        }
        met.insert(module);
    }
    let empty = floors.iter().filter(|module| !met.contains(*module));
    wrong.extend(empty.map(|module| format!("ARCHITECTURE.md: there is no module `{module}`")));
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
