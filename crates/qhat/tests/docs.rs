//! The documents agree with the code: the notation table, the paths that they name, and their links.

use qhat::{Constraint, Force, NOTATION};
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Every document of the project, by its path from the root.
fn documents() -> Vec<String> {
    let mut found: Vec<String> =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(String::from).into();
    for folder in ["docs", "docs/method", "docs/decisions"] {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") {
                found.push(format!("{folder}/{name}"));
            }
        }
    }
    found
}

#[test]
fn notation_table_is_the_one_in_the_code() {
    let table = read("docs/notation.md");
    let first = table.lines().skip_while(|line| !line.starts_with("| symbol | letters |"));
    let rows: Vec<&str> = first.skip(2).take_while(|line| line.starts_with("| ")).collect();
    let expected: Vec<String> = NOTATION
        .iter()
        .map(|n| {
            let (symbol, letters, word, shape, unit, file) = (n.symbol, n.letters, n.word, n.shape, n.unit, n.file);
            format!("| {symbol} | `{letters}` | `{word}` | {shape} | {unit} | `crates/qhat/src/{file}` |")
        })
        .collect();
    assert_eq!(rows, expected);
}

#[test]
fn terms_has_the_fields_of_the_notation_table_in_its_order() {
    let source = read("crates/qhat/src/terms.rs");
    let body = source.split("pub struct Terms {").nth(1).unwrap().split("\n}").next().unwrap();
    let fields: Vec<&str> =
        body.lines().filter_map(|line| line.trim().strip_prefix("pub ")?.split(':').next()).collect();
    let mut words: Vec<&str> = NOTATION.iter().map(|n| n.word).collect();
    words.push("warnings"); // text, so the table of symbols does not have it
    assert_eq!(fields, words);
}

#[test]
fn letters_of_the_notation_table_stand_in_their_files() {
    for n in NOTATION {
        let source = read(&format!("crates/qhat/src/{}", n.file));
        let letters: Vec<&str> = source.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        assert!(letters.contains(&n.letters), "`{}` is not in {}", n.letters, n.file);
    }
}

/// The first page of the Rust documentation groups the kinds by use; a kind that it lacks would not be found.
#[test]
fn the_first_page_of_the_library_names_every_kind() {
    let source = read("crates/qhat/src/lib.rs");
    let page: String = source.lines().filter(|line| line.starts_with("//!")).collect();
    for kind in Constraint::KINDS.iter().chain(Force::KINDS) {
        assert!(page.contains(&format!("[`{kind}`]")), "the head of lib.rs lacks [`{kind}`]");
    }
}

#[test]
fn every_path_named_in_a_document_exists() {
    // Built or written on demand, so not in a fresh clone.
    let made = ["target/", "playground/dist", "playground/node_modules"];
    let mut named = 0;
    for document in documents() {
        for path in read(&document).split('`').skip(1).step_by(2) {
            let is_path = path.contains('/')
                && path.chars().all(|c| c.is_ascii_alphanumeric() || "._-/".contains(c))
                && ["crates/", "docs/", "scenes/", "playground/", "scripts/", "target/", ".ci/", "benches/"]
                    .iter()
                    .any(|start| path.starts_with(start));
            if is_path && !made.iter().any(|start| path.starts_with(start)) {
                named += 1;
                assert!(root().join(path).exists(), "{document} names `{path}`, which does not exist");
            }
        }
    }
    assert!(named > 30, "the search for paths found only {named}");
}

/// The name by which a link finds a heading.
fn heading(line: &str) -> String {
    let text = line.trim_start_matches('#').trim().to_lowercase();
    text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn every_link_in_a_document_leads_somewhere() {
    let mut links = 0;
    for document in documents() {
        let folder = root().join(&document).parent().unwrap().to_path_buf();
        for target in read(&document).split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if target.contains(':') {
                continue;
            }
            links += 1;
            let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
            let path = if path.is_empty() { root().join(&document) } else { folder.join(path) };
            assert!(path.exists(), "{document} links to {target}, which does not exist");
            if !anchor.is_empty() {
                let text = fs::read_to_string(&path).unwrap();
                let has_heading = text.lines().filter(|line| line.starts_with('#')).any(|line| heading(line) == anchor);
                assert!(has_heading, "{document} links to {target}, and no heading has that name");
            }
        }
    }
    assert!(links > 5, "the search for links found only {links}");
}

/// Every line of Rust in README.md, and of the profile that it asks for, stands in the head of `lib.rs`, whose example
/// the documentation tests run.
#[test]
fn code_in_the_readme_is_that_of_the_crate() {
    let readme = read("README.md");
    let source = read("crates/qhat/src/lib.rs");
    let known: Vec<&str> = source.lines().filter_map(|line| line.strip_prefix("//!")).map(str::trim).collect();
    let block = |language: &str, from: &str| -> Vec<String> {
        let text = readme.split(language).find(|text| text.contains(from)).unwrap().split("```").next().unwrap();
        let lines = text.lines().map(str::trim).skip_while(|line| *line != from);
        lines.filter(|line| !line.is_empty()).map(String::from).collect()
    };
    let program = block("```rust\n", "let mut builder = System::builder(Dimension::Two);");
    let profile = block("```toml\n", "[profile.dev.package.qhat]");
    assert!(program.len() > 8 && profile.len() == 7, "{program:?} {profile:?}");
    for line in program.iter().chain(&profile) {
        assert!(known.contains(&line.as_str()), "README.md has a line that the head of lib.rs lacks:\n{line}");
    }
}

/// The worked example names a file in the head of each step, and quotes lines of it. Its tests exist by these names.
#[test]
fn adding_a_constraint_quotes_the_tree() {
    let page = read("docs/adding-a-constraint.md");
    let (mut files, mut lines) = (0, 0);
    for step in page.split("\n## ").skip(1) {
        let Some(path) = step.lines().next().unwrap().split('`').nth(1) else { continue };
        let source = read(path);
        for quoted in step.split("\n```").skip(1).step_by(2) {
            for line in quoted.lines().skip(1).map(str::trim).filter(|line| !line.is_empty()) {
                assert!(source.contains(line), "docs/adding-a-constraint.md quotes a line that {path} lacks:\n{line}");
                lines += 1;
            }
        }
        files += 1;
    }
    assert!(files == 10 && lines > 30, "the search for quotations found {lines} lines of {files} files");

    let mut tests = String::new();
    for folder in ["crates/qhat/tests/kinds", "crates/qhat-scene/tests", "crates/qhat-schema-test/tests"] {
        let entries = fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path());
        for path in entries.filter(|path| path.extension().is_some_and(|end| end == "rs")) {
            tests += &fs::read_to_string(path).unwrap();
        }
    }
    let words = page.split('`').skip(1).step_by(2);
    let named: Vec<&str> = words.filter(|word| word.matches('_').count() > 2 && !word.contains(' ')).collect();
    for name in &named {
        let is_test = tests.contains(&format!("\nfn {name}()"));
        assert!(is_test, "docs/adding-a-constraint.md names the test `{name}`, which does not exist");
    }
    assert!(named.len() >= 5, "the search for tests found only {named:?}");
}

/// Where a crate's tests are one binary, a file beside `main.rs` that it does not list would never be compiled.
#[test]
fn every_file_of_tests_is_compiled() {
    let rust_files = |folder: &Path| -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let found = entries.filter_map(|path| {
            let module =
                path.is_dir() && path.join("mod.rs").exists() || path.extension().is_some_and(|end| end == "rs");
            module.then(|| path.file_stem().unwrap().to_str().unwrap().to_owned())
        });
        found.filter(|name| name != "main" && name != "mod").collect()
    };
    let mut compiled = 0;
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let package = entry.unwrap().path();
        let tests = package.join("tests");
        let Ok(main) = fs::read_to_string(tests.join("main.rs")) else { continue };
        let manifest = fs::read_to_string(package.join("Cargo.toml")).unwrap();
        for name in rust_files(&tests) {
            let is_module = main.contains(&format!("\nmod {name};"));
            let has_a_binary = manifest.contains(&format!("[[test]]\nname = \"{name}\"\n"));
            assert!(is_module || has_a_binary, "{}/{name} is in no list: add it to main.rs", tests.display());
            let folder = tests.join(&name);
            if folder.join("mod.rs").exists() {
                let list = fs::read_to_string(folder.join("mod.rs")).unwrap();
                for inner in rust_files(&folder) {
                    let is_listed = list.contains(&format!("mod {inner};"));
                    assert!(is_listed, "{}/{inner}.rs is in no list: add it to mod.rs", folder.display());
                }
            }
            compiled += 1;
        }
    }
    assert!(compiled > 40, "the search for tests found only {compiled}");
}

/// A manifest that says `test = false` leaves no test uncompiled.
#[test]
fn no_source_has_tests_that_its_manifest_leaves_out() {
    fn walk(folder: &Path) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let source = fs::read_to_string(&path).unwrap();
                assert!(!source.contains("#[test]"), "{}: its manifest says `test = false`", path.display());
            }
        }
    }
    let mut left_out = 0;
    for entry in fs::read_dir(root().join("crates")).unwrap() {
        let package = entry.unwrap().path();
        if fs::read_to_string(package.join("Cargo.toml")).unwrap().contains("\ntest = false\n") {
            walk(&package.join("src"));
            left_out += 1;
        }
    }
    assert!(left_out > 0, "no manifest says `test = false`: remove this test");
}
