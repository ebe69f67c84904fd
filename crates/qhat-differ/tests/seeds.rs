//! qhat agrees with the reference on some hundred frameworks; `make fuzz` tries thousands.

use qhat_differ::seeds::{described, seeds};
use std::sync::Mutex;

/// The seeds of a test run: every family some thirty times, in under 20 s.
const SEEDS: u64 = 390;

/// Families and seeds in which the engine is known to be wrong, and that wait for its mending: a singular position that
/// is passed, joints that rods hold to second order, and redundant rows under the methods that solve at the end of the
/// step.
const OPEN_FAMILIES: [&str; 2] = ["cranks through flat", "three in line"];
const OPEN_SEEDS: [u64; 2] = [319, 382];

#[test]
fn long_qhat_agrees_with_the_reference() {
    let found = Mutex::new(Vec::new());
    let outcome = seeds(0..SEEDS, &|family| !OPEN_FAMILIES.contains(&family), &|seed, verdict| {
        if !verdict.findings.is_empty() && !OPEN_SEEDS.contains(&seed) {
            found.lock().unwrap().push(described(seed, verdict));
        }
    });
    let found = found.into_inner().unwrap();
    let again = "cargo run --release --package qhat-differ -- seed N";
    assert!(found.is_empty(), "{} seeds differ; {again} repeats one\n\n{}", found.len(), found.join("\n\n"));
    // A test that compares little would pass, too.
    let skipped: usize = outcome.skipped.values().sum();
    let open = SEEDS * OPEN_FAMILIES.len() as u64 / 13;
    assert!(outcome.compared as u64 == SEEDS - open && skipped < outcome.compared / 10, "{:?}", outcome.skipped);
}
