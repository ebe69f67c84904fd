//! qhat takes any scene: 600 hostile ones here, new ones by `make fuzz MINUTES=n`.

use qhat_differ::hostile::{corpus, input, trial::attempt};
use qhat_scene::load_bytes;

/// The inputs of a test run.
const INPUTS: u64 = 600;

#[test]
fn long_hostile_scenes_end_in_words_or_in_numbers() {
    let corpus = corpus();
    let mut found = Vec::new();
    let mut valid = 0;
    for number in 0..INPUTS {
        let input = input(&corpus, number);
        valid += u64::from(load_bytes(&input.bytes, "hostile", input.format).is_ok());
        if let Err(fault) = attempt(&input) {
            let text = String::from_utf8_lossy(&input.bytes).into_owned();
            found.push(format!("input {number}, {}: {}\n{text}", fault.kind, fault.seen));
        }
    }
    assert!(found.is_empty(), "{} inputs with a fault:\n\n{}", found.len(), found.join("\n\n"));
    // Scenes that all end in the reader would not try the engine, and valid scenes alone would not try the reader.
    assert!((INPUTS / 5..INPUTS * 4 / 5).contains(&valid), "{valid} of {INPUTS} inputs can be read");
}
