//! The measurements of qhat itself in `make bench`; docs/benchmarks.md describes them and how to read them.

use qhat_bench::trajectory::{Writer, measure};
use qhat_bench::{Row, Series, Setting, Workload, kernels, quickest, run, scenes, settings};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;
use std::{env, fs};

const USAGE: &str = "Usage:
  qhat-bench scenes [SCENE …]                     every shipped scene, into benches/results/scenes.csv
  qhat-bench workloads [WORKLOAD …]               every workload, into benches/results/workloads.csv
  qhat-bench kernels [--keep]                     instructions beside the kept counts; --keep replaces these
  qhat-bench settings WORKLOAD                    the settings of its measurements, one on each line
  qhat-bench neutral WORKLOAD FILE                the file that the other engines read
  qhat-bench trajectory WORKLOAD SETTING SECONDS FILE
                                                  the trajectory of a run of qhat, of at most SECONDS of CPU
  qhat-bench measure WORKLOAD FILE                the errors of a trajectory of any engine
With names of scenes or workloads, results are printed and no file is written.";

/// Most CPU time of one run of `workloads`. A run that needs more is stopped, and its row has the time that it reached.
const LIMIT: Duration = Duration::from_secs(10);

fn main() -> ExitCode {
    match command() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn command() -> Result<(), Box<dyn Error>> {
    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/results");
    fs::create_dir_all(&results)?;
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["scenes", ..] => scenes::scenes(&arguments[1..], &results),
        ["workloads", ..] => workloads(&words[1..], &results.join("workloads.csv")),
        ["kernels"] => kernels::compare(&results.join("instructions.csv"), false),
        ["kernels", "--keep"] => kernels::compare(&results.join("instructions.csv"), true),
        ["kernel", name] => kernels::run_one(name),
        ["settings", workload] => {
            settings(&workload.parse()?).iter().for_each(|setting| println!("{setting}"));
            Ok(())
        }
        ["neutral", workload, file] => Ok(fs::write(file, workload.parse::<Workload>()?.json())?),
        ["trajectory", workload, setting, seconds, file] => {
            let limit = Duration::try_from_secs_f64(seconds.parse()?)?;
            trajectory(&workload.parse()?, &setting.parse()?, limit, Path::new(file))
        }
        ["measure", workload, file] => {
            let (frames, errors) = measure(&workload.parse()?, Path::new(file))?;
            let (worst, rms) = (errors.worst_length, errors.rms_length());
            println!("{frames} {worst:e} {rms:e} {:e} {:e}", errors.energy(), errors.energy_max());
            Ok(())
        }
        _ => Err(USAGE.into()),
    }
}

fn workloads(wanted: &[&str], file: &Path) -> Result<(), Box<dyn Error>> {
    let mut csv = format!("{}\n", Row::CSV);
    println!("{}", Row::heading());
    Series::new(wanted, None, LIMIT)?.run(|row| {
        println!("{row}");
        csv += &row.csv();
        csv += "\n";
        Ok::<(), Box<dyn Error>>(())
    })?;
    if wanted.is_empty() {
        fs::write(file, csv)?;
    }
    Ok(())
}

/// One run, with the same output as from the other engines: the trajectory in a file, and on one line the CPU seconds
/// and the reason of an early end.
fn trajectory(workload: &Workload, setting: &Setting, limit: Duration, file: &Path) -> Result<(), Box<dyn Error>> {
    let mut written = Writer::create(file)?;
    let mut failed = Ok(());
    let outcome = run(workload, setting, limit, |positions, velocities| {
        if failed.is_ok() {
            failed = written.frame(positions, velocities);
        }
    })?;
    failed?;
    written.finish()?;
    let quickest = quickest(outcome, || run(workload, setting, limit, |_, _| ()))?;
    println!("{} {}", quickest.cpu.as_secs_f64(), quickest.ended.unwrap_or_default());
    Ok(())
}
