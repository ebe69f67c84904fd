//! The command of the differential test.
//!
//! ```text
//! qhat-differ seed N             compares one seed and prints its scene and every difference
//! qhat-differ seeds FROM COUNT   compares many, and lists those that differ
//! qhat-differ fuzz MINUTES       compares seeds for half of the time, and tries hostile scenes for the other half
//! qhat-differ try FILE           tries one hostile scene
//! ```

use qhat_differ::hostile::{Input, process, process::work, trial};
use qhat_differ::seeds::{Outcome, described, seeds};
use qhat_scene::Format;
use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

const USAGE: &str = "usage: qhat-differ seed N | seeds FROM COUNT | fuzz MINUTES | try FILE";

/// Seeds between two looks at the clock.
const SEEDS_AT_ONCE: u64 = 260;
/// The folder of hostile scenes with a fault.
const FOLDER: &str = "target/hostile";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let numbers: Option<Vec<u64>> = arguments.iter().skip(1).map(|text| text.parse().ok()).collect();
    let is_clean = match (arguments.first().map(String::as_str), numbers.as_deref()) {
        (Some("seed"), Some(&[seed])) => one(seed),
        (Some("seeds"), Some(&[from, count])) => many(from, count),
        (Some("fuzz"), Some(&[minutes])) => fuzz(minutes),
        _ => match arguments.iter().map(String::as_str).collect::<Vec<&str>>()[..] {
            ["try", file] => attempt(Path::new(file)),
            ["worker", folder, batch] => batch.parse().is_ok_and(|batch| work(Path::new(folder), batch).is_ok()),
            _ => {
                eprintln!("{USAGE}");
                return ExitCode::from(2);
            }
        },
    };
    if is_clean { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// One seed with its scene; whether qhat and the reference agree.
fn one(seed: u64) -> bool {
    let outcome = seeds(seed..seed.saturating_add(1), &|seed, verdict| {
        print!("{}", described(seed, verdict));
        println!("the largest difference is {:.1e} of what is allowed", verdict.worst);
    });
    outcome.wrong.is_empty()
}

/// Many seeds, with progress on the terminal; whether qhat and the reference agree on all of them.
fn many(from: u64, count: u64) -> bool {
    let (start, done) = (Instant::now(), AtomicU64::new(0));
    let outcome = seeds(from..from.saturating_add(count), &|seed, verdict| {
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if !verdict.findings.is_empty() {
            eprintln!("\n{}", described(seed, verdict));
        }
        if done % 10 == 0 || done == count {
            eprint!("\r{done} of {count} seeds, {:.0} s", start.elapsed().as_secs_f64());
            // Progress that cannot be shown is no error.
            drop(std::io::stderr().flush());
        }
    });
    eprintln!();
    print(&outcome);
    outcome.wrong.is_empty()
}

/// Seeds for half of the minutes, hostile scenes for the other half; whether nothing was found.
///
/// Both begin at a number that grows by a million a second, faster than any machine tries seeds or batches. So every
/// run tries something new.
fn fuzz(minutes: u64) -> bool {
    let half = Duration::from_secs(30 * minutes);
    let first = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |time| time.as_micros() as u64);
    let (start, mut next, mut is_clean) = (Instant::now(), first, true);
    while start.elapsed() < half {
        is_clean &= many(next, SEEDS_AT_ONCE);
        next += SEEDS_AT_ONCE;
    }
    let outcome = process::fuzz(Path::new(FOLDER), half, first);
    is_clean
        & outcome.unwrap_or_else(|error| {
            eprintln!("{FOLDER}: {error}");
            false
        })
}

/// One hostile scene; whether it shows no fault.
fn attempt(path: &Path) -> bool {
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("{}: {error}", path.display());
            return false;
        }
    };
    match trial::attempt(&Input { bytes, format: Format::from_path(&path.to_string_lossy()) }) {
        Ok(()) => true,
        Err(fault) => {
            println!("{}: {}", fault.kind, fault.seen);
            false
        }
    }
}

fn print(outcome: &Outcome) {
    println!("{} seeds compared, {} of them differ", outcome.compared, outcome.wrong.len());
    for (seed, family) in &outcome.wrong {
        println!("    seed {seed}, {family}");
    }
    for ((family, reason), count) in &outcome.skipped {
        println!("not all was compared of {count} seeds, {family}: {reason}");
    }
    for (family, worst) in &outcome.worst {
        println!("{family}: the largest difference is {worst:.1e} of what is allowed");
    }
}
