//! Many seeds on every core, with progress and a list of findings.

use crate::compare::{Verdict, compare, read};
use crate::generate::framework;
use crate::write::format_of;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// The outcome of many seeds.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// The number of seeds that were compared.
    pub compared: usize,
    /// The seeds with findings, each with its family.
    pub wrong: BTreeMap<u64, &'static str>,
    /// The number of seeds of which not all was compared, by family and reason.
    pub skipped: BTreeMap<(&'static str, &'static str), usize>,
    /// The largest difference as a part of the allowed one, by family \[1\].
    pub worst: BTreeMap<&'static str, f64>,
}

/// Compares the seeds of a range, and calls `tell` with each as it ends, from any thread.
pub fn seeds(range: Range<u64>, tell: &(dyn Fn(u64, &Verdict) + Sync)) -> Outcome {
    let next = AtomicU64::new(range.start);
    let outcome = Mutex::new(Outcome::default());
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= range.end {
                return;
            }
            let framework = framework(seed);
            let verdict = compare(&framework, &read);
            tell(seed, &verdict);
            let mut outcome = outcome.lock().expect("no thread panics while it holds the lock");
            outcome.compared += 1;
            if let Some(reason) = verdict.skipped {
                *outcome.skipped.entry((framework.family, reason)).or_default() += 1;
            }
            let worst = outcome.worst.entry(framework.family).or_default();
            *worst = worst.max(verdict.worst);
            if !verdict.findings.is_empty() {
                outcome.wrong.insert(seed, framework.family);
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    outcome.into_inner().expect("every thread has ended")
}

/// A seed in words: its scene, and every number in which qhat and the reference differ.
pub fn described(seed: u64, verdict: &Verdict) -> String {
    let framework = framework(seed);
    let mut text = format!("seed {seed}, {}\n\n{}\n", framework.family, framework.text(format_of(seed)));
    for finding in &verdict.findings {
        let crate::compare::Finding { what, qhat, reference, off, allowed } = finding;
        text += &format!("{what}: off by {off:.1e}, allowed {allowed:.1e}\n    qhat       {qhat}\n");
        text += &format!("    reference  {reference}\n");
    }
    if let Some(reason) = verdict.skipped {
        text += &format!("not all was compared: {reason}\n");
    }
    text
}
