//! The same bits on every target: a hash of q, q̇ and λ after some steps of shipped scenes, and a hash of what a
//! simulation saves, equal in debug, in release and in WebAssembly (`crates/qhat-wasm/tests/golden.mjs` reads the same
//! files). Equal bytes on two targets are a run that goes on from one target to the other.
//!
//! A change that is meant to change bits, in the engine or in a scene, writes the files anew:
//! `QHAT_GOLDEN=write cargo test --release --package qhat-scene --test golden`, and says so in its message.

use qhat::{Settings, Simulation};
use std::fmt::Write as _;

const CASES: &str = include_str!("golden.txt");
const SAVED: &str = include_str!("saved.txt");

/// The frames after each of which a simulation is saved and restored.
const FRAMES: usize = 10;

/// FNV-1a (Fowler, Noll, Vo), 64 bits, over the bytes of the numbers, least significant first.
fn hash<'a>(numbers: impl Iterator<Item = &'a f64>) -> u64 {
    hash_of(numbers.flat_map(|number| number.to_bits().to_le_bytes()))
}

fn hash_of(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// One line: scene, integrator, h [s], steps, hash.
fn run(words: &[&str]) -> String {
    let [name, integrator, h, steps, ..] = words else { panic!("scene, integrator, h, steps, hash: {words:?}") };
    let shipped = qhat_scene::shipped().iter().find(|shipped| shipped.name == *name);
    let scene = shipped.unwrap_or_else(|| panic!("no scene is called {name}")).load().unwrap();
    let mut simulation: Simulation = scene.simulation().unwrap();
    let h = h.parse().unwrap();
    let settings = Settings { integrator: integrator.parse().unwrap(), h, ..*simulation.settings() };
    simulation.set_settings(settings).unwrap();
    for step in 0..steps.parse().unwrap() {
        simulation.step().unwrap_or_else(|error| panic!("{words:?}, step {step}: {error}"));
    }
    let lambda = simulation.terms().multipliers;
    let state = simulation.state();
    format!("{:016x}", hash(state.positions().iter().chain(state.velocities()).chain(&lambda)))
}

#[test]
fn every_case_ends_in_the_same_bits() {
    let mut fresh = String::new();
    let mut wrong = Vec::new();
    for line in CASES.lines() {
        if line.is_empty() || line.starts_with('#') {
            writeln!(fresh, "{line}").unwrap();
            continue;
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        let hash = run(&words);
        writeln!(fresh, "{:<16} {:<17} {:<6} {:>4}  {hash}", words[0], words[1], words[2], words[3]).unwrap();
        if words.get(4) != Some(&hash.as_str()) {
            wrong.push(format!("{line}\n    is now {hash}"));
        }
    }
    write_or_refuse("golden.txt", &fresh, &wrong);
}

/// Every shipped scene, saved after every frame and restored, ends in the bytes of a run that was not.
#[test]
fn every_scene_goes_on_from_saved_bytes_to_the_same_bytes() {
    let mut fresh =
        String::from("# scene, and the hash of the simulation that it saves after 10 frames: see golden.rs.\n");
    for shipped in qhat_scene::shipped() {
        let scene = shipped.load().unwrap();
        let mut whole = scene.simulation().unwrap();
        let mut restored = whole.clone();
        for _ in 0..FRAMES {
            let bytes = restored.to_bytes();
            restored = Simulation::restore(scene.system.clone(), &bytes).unwrap();
            let outcomes = (whole.step().is_ok(), restored.step().is_ok());
            assert_eq!(outcomes, (true, true), "{}", shipped.name);
        }
        let bytes = whole.to_bytes();
        assert!(bytes == restored.to_bytes(), "{}", shipped.name);
        writeln!(fresh, "{:<20} {:016x}", shipped.name, hash_of(bytes.into_iter())).unwrap();
    }
    let wrong: Vec<String> = fresh
        .lines()
        .filter(|line| !SAVED.lines().any(|known| known == *line))
        .map(|line| format!("now {line}"))
        .collect();
    write_or_refuse("saved.txt", &fresh, &wrong);
}

/// Writes a file anew where the environment asks for it; else asks that nothing is wrong.
fn write_or_refuse(file: &str, fresh: &str, wrong: &[String]) {
    if std::env::var_os("QHAT_GOLDEN").is_some_and(|value| value == "write") {
        std::fs::write(format!("{}/tests/{file}", env!("CARGO_MANIFEST_DIR")), fresh).unwrap();
    } else {
        let how = "if that is meant: QHAT_GOLDEN=write cargo test --release --package qhat-scene --test golden";
        assert!(wrong.is_empty(), "other bits than before:\n{}\n{how}", wrong.join("\n"));
    }
}

/// The hash itself: the published test vector of the empty input, and the hash of eight zero bytes, computed by hand.
#[test]
fn hash_is_fnv_1a() {
    assert_eq!(hash([].iter()), 0xcbf2_9ce4_8422_2325);
    let zeros = (0..8).fold(0xcbf2_9ce4_8422_2325_u64, |hash, _| hash.wrapping_mul(0x0100_0000_01b3));
    assert_eq!(hash([0.0].iter()), zeros);
    assert_ne!(hash([0.0].iter()), hash([-0.0].iter()), "the sign of zero counts");
}
