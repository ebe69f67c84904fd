//! Hostile scenes: changed scenes, changed bytes and random expressions, and the answers that qhat must never give.
//!
//! No panic, no abort, no hang. A scene that can be read either ends in an error with words, or goes on with numbers
//! that are finite, constraints that hold, and energy that is accounted for.

mod change;
mod expression;
pub mod process;
pub mod trial;

use crate::generate::framework;
use crate::random::Random;
use change::{change, change_bytes};
use qhat_scene::{Format, shipped};
use serde_json::Value;

/// Scenes with every key of the format, beside those that are shipped.
const EVERY_KEY: [&str; 3] = [
    include_str!("../../../qhat-scene/tests/every-key.toml"),
    include_str!("../../../qhat-scene/tests/every-key-in-space.toml"),
    include_str!("../../../qhat-scene/tests/every-contact.toml"),
];

/// The longest shipped scene that is changed \[bytes\]; longer ones have more of the same.
const LONGEST: usize = 6000;

/// A text with its format.
#[derive(Clone, Debug)]
pub struct Input {
    /// The text.
    pub bytes: Vec<u8>,
    /// TOML or JSON.
    pub format: Format,
}

/// The scenes that are changed.
pub fn corpus() -> Vec<Value> {
    let short = shipped().iter().map(|scene| scene.text).filter(|text| text.len() < LONGEST);
    let texts = short.chain(EVERY_KEY).map(|text| toml::from_str(text).expect("scenes of the project are valid TOML"));
    // Frameworks of the differential test: redundant rows, mass ratios, drives, singular positions.
    let frameworks = (0..39)
        .map(|seed| serde_json::from_str(&framework(seed).text(Format::Json)).expect("frameworks are valid JSON"));
    texts.chain(frameworks).collect()
}

/// The input that belongs to a number.
pub fn input(corpus: &[Value], number: u64) -> Input {
    let mut random = Random::new(number ^ 0x0005_7a11_ed5c_e4e5);
    let mut scene = random.pick(corpus).clone();
    let mut other = random.pick(corpus).clone();
    for _ in 0..random.below(4) {
        change(&mut random, &mut scene, &mut other);
    }
    let as_toml = random.chance(0.3).then(|| toml::to_string(&scene).ok()).flatten();
    let (text, format) = match as_toml {
        Some(text) => (text, Format::Toml),
        // JSON has values that TOML lacks, such as null.
        None => (scene.to_string(), Format::Json),
    };
    let mut bytes = text.into_bytes();
    if random.chance(0.15) {
        for _ in 0..1 + random.below(4) {
            change_bytes(&mut random, &mut bytes);
        }
    }
    Input { bytes, format }
}
