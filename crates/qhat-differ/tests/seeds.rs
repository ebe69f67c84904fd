//! qhat agrees with the reference on some hundred frameworks; `make fuzz` tries thousands.

use qhat_differ::seeds::{described, seeds};
use std::sync::Mutex;

/// The seeds of a test run: every family some thirty times, in under 20 s.
const SEEDS: u64 = 390;

#[test]
fn long_qhat_agrees_with_the_reference() {
    let found = Mutex::new(Vec::new());
    let outcome = seeds(0..SEEDS, &|seed, verdict| {
        if !verdict.findings.is_empty() {
            found.lock().unwrap().push(described(seed, verdict));
        }
    });
    let found = found.into_inner().unwrap();
    let again = "cargo run --release --package qhat-differ -- seed N";
    assert!(found.is_empty(), "{} seeds differ; {again} repeats one\n\n{}", found.len(), found.join("\n\n"));
    // A test that compares little would pass, too.
    let skipped: usize = outcome.skipped.values().sum();
    assert!(outcome.compared as u64 == SEEDS && skipped < outcome.compared / 10, "{:?}", outcome.skipped);
}
