//! Hostile scenes in processes of their own, so that an abort or a hang ends one process and is told with its input.
//!
//! A worker writes each input to a file before it tries it. The parent watches that file: one that stays for too long
//! is a hang, one that outlives its worker an abort. Inputs with a fault stay in the folder, named after the fault.

use super::trial::{Fault, attempt};
use super::{Input, corpus, input};
use qhat_scene::Format;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The inputs of one worker; a new process costs as much as some of them.
const BATCH: u64 = 500;
/// The time after which an input is a hang.
const HANG: Duration = Duration::from_secs(60);
/// The memory of a worker \[KiB\]: 4 GiB. A scene of a few kilobytes that needs more is an abort elsewhere.
const MEMORY: u64 = 4 << 20;
/// The number of inputs with one kind of fault at which a run ends.
const KEPT: usize = 20;

fn extension(format: Format) -> &'static str {
    match format {
        Format::Toml => "toml",
        Format::Json => "json",
    }
}

/// Tries the inputs of a batch, as a worker; writes those with a fault.
///
/// # Errors
/// A file that cannot be written.
pub fn work(folder: &Path, batch: u64) -> std::io::Result<()> {
    // `attempt` reports a panic as a fault, so its message is not printed as well.
    std::panic::set_hook(Box::new(|_| {}));
    let corpus = corpus();
    let current = folder.join(format!("current-{batch}"));
    for number in batch * BATCH..(batch + 1) * BATCH {
        let input = input(&corpus, number);
        fs::write(&current, &input.bytes)?;
        if let Err(fault) = attempt(&input) {
            keep(folder, number, &input, &fault)?;
        }
    }
    fs::remove_file(current)
}

/// Writes an input with a fault, and the fault beside it.
fn keep(folder: &Path, number: u64, input: &Input, fault: &Fault) -> std::io::Result<()> {
    let name = format!("{}-{number}", fault.kind.replace(' ', "-"));
    fs::write(folder.join(format!("{name}.{}", extension(input.format))), &input.bytes)?;
    fs::write(folder.join(format!("{name}.txt")), format!("{}: {}\n", fault.kind, fault.seen))
}

/// Runs one batch in a process of its own, and ends it where it hangs.
fn watch(folder: &Path, batch: u64) -> std::io::Result<()> {
    let program = std::env::current_exe()?;
    let limited = format!("ulimit -v {MEMORY}; exec \"$0\" worker \"$1\" \"$2\"");
    let mut child = Command::new("sh")
        .args(["-c", &limited])
        .args([program.as_os_str(), folder.as_os_str()])
        .arg(batch.to_string())
        .stderr(Stdio::null())
        .spawn()?;
    let current = folder.join(format!("current-{batch}"));
    let age = || fs::metadata(&current).ok()?.modified().ok()?.elapsed().ok();
    let kind = loop {
        std::thread::sleep(Duration::from_millis(20));
        if let Some(status) = child.try_wait()? {
            break if status.success() { None } else { Some("abort") };
        }
        if age().is_some_and(|age| age > HANG) {
            child.kill()?;
            child.wait()?;
            break Some("hang");
        }
    };
    let Some(kind) = kind else { return Ok(()) };
    let bytes = fs::read(&current)?;
    let corpus = corpus();
    let numbers = batch * BATCH..(batch + 1) * BATCH;
    // The input follows from its number; the file says which of the batch it was.
    let found = numbers.map(|number| (number, input(&corpus, number))).find(|(_, input)| input.bytes == bytes);
    fs::remove_file(&current)?;
    let Some((number, input)) = found else { return Ok(()) };
    keep(folder, number, &input, &Fault { kind, seen: format!("batch {batch}") })
}

/// Tries inputs for a time, from the batch `first` on, with progress; whether no fault was found.
///
/// The folder may have inputs of earlier runs, whose batches come before `first`: they stay, and do not count.
///
/// # Errors
/// A file that cannot be written, a process that cannot be started.
pub fn fuzz(folder: &Path, duration: Duration, first: u64) -> std::io::Result<bool> {
    fs::create_dir_all(folder)?;
    let start = Instant::now();
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let mut batch = first;
    let mut count = 0;
    while start.elapsed() < duration {
        let watched: std::io::Result<Vec<()>> = std::thread::scope(|scope| {
            let started: Vec<_> =
                (batch..batch + threads).map(|batch| scope.spawn(move || watch(folder, batch))).collect();
            started.into_iter().map(|thread| thread.join().expect("a watch does not panic")).collect()
        });
        watched?;
        batch += threads;
        let faults = faults(folder, first)?;
        count = faults.values().map(Vec::len).sum();
        let seconds = start.elapsed().as_secs();
        eprint!("\r{} scenes, {count} with a fault, {seconds} of {} s", (batch - first) * BATCH, duration.as_secs());
        if faults.values().any(|paths| paths.len() >= KEPT) {
            break;
        }
    }
    eprintln!();
    for (kind, paths) in faults(folder, first)? {
        println!("{kind}: {} scenes", paths.len());
        for path in paths.iter().take(KEPT) {
            println!("    {}: {}", path.display(), fs::read_to_string(path.with_extension("txt"))?.trim());
        }
    }
    Ok(count == 0)
}

/// The inputs with a fault of the batches from `first` on, by kind.
fn faults(folder: &Path, first: u64) -> std::io::Result<BTreeMap<String, Vec<PathBuf>>> {
    let mut faults = BTreeMap::<String, Vec<PathBuf>>::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
        let scene = path.extension().is_some_and(|end| end == "toml" || end == "json");
        let Some((kind, number)) = name.rsplit_once('-') else { continue };
        if scene && number.parse::<u64>().is_ok_and(|number| number >= first * BATCH) {
            faults.entry(kind.to_owned()).or_default().push(path);
        }
    }
    faults.values_mut().for_each(|paths| paths.sort());
    Ok(faults)
}
