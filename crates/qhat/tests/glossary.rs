//! Every word of `docs/glossary.md` occurs in the file that the glossary names for it.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A text as words between single spaces, in lower case: `write_event_functions` and `EventFunctions` both contain the
/// words "event functions", and a comment may break a line between them.
fn words(text: &str) -> String {
    let mut spaced = String::new();
    let mut was_lower = false;
    for letter in text.chars() {
        if letter.is_uppercase() && was_lower {
            spaced.push(' ');
        }
        was_lower = letter.is_lowercase();
        if letter.is_alphanumeric() {
            spaced.extend(letter.to_lowercase());
        } else {
            spaced.push(' ');
        }
    }
    spaced.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Term, symbol, file and sentence of each row.
fn rows(text: &str) -> Vec<[&str; 4]> {
    let table = text.lines().skip_while(|line| *line != "| term | symbol | file | sentence |").skip(2);
    let rows = table.take_while(|line| line.starts_with('|'));
    rows.map(|row| {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        cells.try_into().unwrap_or_else(|cells: Vec<&str>| panic!("four cells, not {}: {row}", cells.len()))
    })
    .collect()
}

#[test]
fn every_word_of_the_glossary_stands_in_its_file() {
    let glossary = fs::read_to_string(root().join("docs/glossary.md")).unwrap();
    let rows = rows(&glossary);
    assert!(rows.len() >= 40, "the search for words found only {}", rows.len());
    let mut wrong = Vec::new();
    for [term, _, file, sentence] in &rows {
        // The text in brackets is another word for the same term.
        let term = term.split(" (").next().unwrap();
        let path = file.trim_matches('`');
        match fs::read_to_string(root().join(path)) {
            Err(error) => wrong.push(format!("{term}: {path}: {error}")),
            Ok(text) if !words(&text).contains(&words(term)) => wrong.push(format!("{term} is not in {path}")),
            Ok(_) => {}
        }
        if !sentence.ends_with('.') {
            wrong.push(format!("{term}: not a sentence: {sentence}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_glossary_is_in_alphabetical_order() {
    let glossary = fs::read_to_string(root().join("docs/glossary.md")).unwrap();
    let terms: Vec<String> = rows(&glossary).iter().map(|row| words(row[0])).collect();
    for pair in terms.windows(2) {
        assert!(pair[0] < pair[1], "{} stands before {}", pair[0], pair[1]);
    }
}

#[test]
fn words_are_found_in_identifiers_and_across_lines() {
    let found = words("fn write_event_functions() // rest\n/// speed of RestThresholds");
    assert!(found.contains("event functions") && found.contains("rest speed") && found.contains("rest thresholds"));
    assert!(!found.contains("active set"));
}
