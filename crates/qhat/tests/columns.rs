//! Every hand-written line of the repository has at most 120 columns: code, comments, strings, scenes, prose.

use std::fs;
use std::path::{Path, PathBuf};

/// Columns of a line. Two windows fit beside each other on a common screen, and a review shows no wrapped line.
const COLUMNS: usize = 120;

/// Folders with generated files, or with texts that are stored exactly as a test needs them.
const SKIPPED_FOLDERS: [&str; 9] =
    [".git", "target", "node_modules", "dist", "broken", "golden", "__pycache__", ".venv", "test-results"];

/// Folders that a build makes, by their path from the root.
const BUILT: [&str; 1] = ["playground/src/wasm"];

/// Files that a tool writes.
const GENERATED: [&str; 2] = ["package-lock.json", "Cargo.lock"];

/// Endings of hand-written files.
const ENDINGS: &str = "rs md toml ts mts svelte css html js mjs json jsonc py cpp hpp sh cff yml yaml editorconfig \
    gitattributes";

/// Hand-written files without an ending, by their path from the root.
const NAMED: [&str; 8] = [
    "Makefile",
    "scripts/setup",
    "scripts/build-wasm",
    "scripts/check",
    "scripts/toolchain",
    "scripts/embed-font",
    ".ci/run",
    "benches/peers/run",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Adds every hand-written file under `folder`, by its path from the root with `/` between its parts.
fn collect(root: &Path, folder: &str, found: &mut Vec<String>) {
    for entry in fs::read_dir(root.join(folder)).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        let path = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
        if entry.file_type().unwrap().is_dir() {
            if !SKIPPED_FOLDERS.contains(&name.as_str()) && !BUILT.contains(&path.as_str()) {
                collect(root, &path, found);
            }
            continue;
        }
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        let is_written = ENDINGS.split(' ').any(|known| known == ending) || NAMED.contains(&path.as_str());
        if is_written && !GENERATED.contains(&name.as_str()) {
            found.push(path);
        }
    }
}

/// Whether a line may be longer: a row of a table in Markdown or in a comment, which cannot be continued on the next
/// line, or a line with one long address only.
fn is_excepted(line: &str) -> bool {
    let content = line.trim_start().trim_start_matches(['/', '!', '#', '*', '<', '>']).trim();
    let is_table = content.starts_with('|') && content.ends_with('|');
    let is_address = content.contains("://") && content.split_whitespace().count() == 1;
    is_table || is_address
}

/// Number of columns of a line. A dot or hat over a letter, as in q̇ and Q̂, takes no column of its own.
fn columns(line: &str) -> usize {
    line.chars().filter(|letter| !('\u{300}'..='\u{36f}').contains(letter)).count()
}

fn offenders(path: &str, text: &str) -> Vec<String> {
    let long = text.lines().enumerate().filter(|(_, line)| columns(line) > COLUMNS && !is_excepted(line));
    long.map(|(k, line)| format!("{path}:{}: {} columns", k + 1, columns(line))).collect()
}

#[test]
fn no_line_is_longer_than_120_columns() {
    let root = root();
    let mut files = Vec::new();
    collect(&root, "", &mut files);
    files.sort();
    assert!(files.len() > 300, "the search for files found only {}", files.len());
    let found: Vec<String> =
        files.iter().flat_map(|path| offenders(path, &fs::read_to_string(root.join(path)).unwrap())).collect();
    assert!(found.is_empty(), "{} lines have more than {COLUMNS} columns:\n{}", found.len(), found.join("\n"));
}

#[test]
fn long_lines_are_found_and_exceptions_are_known() {
    let long = "x".repeat(COLUMNS + 1);
    assert_eq!(offenders("a.rs", &format!("short\n{long}\n")), ["a.rs:2: 121 columns"]);
    // Columns are counted, not bytes.
    assert!(offenders("a.md", &"λ".repeat(COLUMNS)).is_empty());
    assert!(offenders("a.md", &"q\u{307}".repeat(COLUMNS)).is_empty());
    assert!(offenders("a.md", &format!("| {long} |")).is_empty());
    assert!(offenders("a.rs", &format!("//! | {long} |")).is_empty());
    assert!(offenders("a.rs", &format!("    // https://example.org/{long}")).is_empty());
    assert_eq!(offenders("a.rs", &format!("// see https://example.org/{long}")).len(), 1);
}
