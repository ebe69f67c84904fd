//! Seven kernels, small pieces of work whose instructions callgrind counts. Other programs on the machine hardly change
//! the count, so it shows a change of a few percent. A measured time does not.

use crate::setting::Setting;
use crate::workload::Workload;
use qhat::{Integrator, Parameter, Quantity, Settings, Simulation, StepError, System, Workspace, evaluate, project};
use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::{env, fs, io};

type Kernel = Box<dyn FnMut() -> Result<(), StepError>>;
type SetUp = fn() -> Result<Kernel, Box<dyn Error>>;

/// Each kernel: its name and the function that sets it up.
const KERNELS: [(&str, SetUp); 7] = [
    ("chain100-dop853-frame", || frame("chain100", Integrator::Dop853)),
    ("chain100-rattle-frame", || frame("chain100", Integrator::Rattle)),
    ("net32-rattle-frame", || frame("net32", Integrator::Rattle)),
    ("truss20r-dop853-frame", || frame("truss20r", Integrator::Dop853)),
    ("net32-projection", projection),
    ("chain100-evaluate", terms),
    ("chain100-bind", bind),
];

/// One frame of 1 ms, after 0.1 s of motion. At the start all particles are at rest, and a step is cheaper than later.
fn frame(name: &str, integrator: Integrator) -> Result<Kernel, Box<dyn Error>> {
    let (system, state) = name.parse::<Workload>()?.system()?;
    let settings = Setting { integrator, tolerance: 1e-4 }.settings(1e-3);
    let mut simulation = Simulation::new(system, state, settings)?;
    simulation.advance(0.1)?;
    Ok(Box::new(move || {
        black_box(simulation.step()?);
        Ok(())
    }))
}

/// The projection of a net whose particles were moved by up to a hundredth of a rod.
fn projection() -> Result<Kernel, Box<dyn Error>> {
    let net: Workload = "net32".parse()?;
    let (system, state) = net.system()?;
    let coordinates = net.positions.len();
    let moved = net.positions.iter().enumerate().map(|(i, x)| x + 1e-4 * (i as f64 * 0.7).sin()).collect();
    let mut state = state.with_motion(moved, vec![0.0; coordinates]);
    let mut workspace = Workspace::new(&system);
    Ok(Box::new(move || {
        black_box(project(&system, &mut state, &Settings::default(), &mut workspace)?);
        Ok(())
    }))
}

/// One evaluation of all symbols of the equation.
fn terms() -> Result<Kernel, Box<dyn Error>> {
    let (system, state) = "chain100".parse::<Workload>()?.system()?;
    Ok(Box::new(move || {
        black_box(evaluate(&system, &state));
        Ok(())
    }))
}

/// One bind of ten parameters: the lengths of five rods, the masses of four particles, gravity.
fn bind() -> Result<Kernel, Box<dyn Error>> {
    let (mut system, values) = bound_chain()?;
    Ok(Box::new(move || Ok(system.bind(black_box(&values))?)))
}

/// A chain of 100 rods with ten parameters, and values of them.
///
/// # Errors
/// None that a user can cause.
pub fn bound_chain() -> Result<(System, Vec<f64>), Box<dyn Error>> {
    let mut builder = "chain100".parse::<Workload>()?.builder();
    let (plain, _) = builder.build()?;
    let rod = |k: usize| Quantity::Constraint(plain.constraint_at(k).expect("a rod"), "length".into(), 0);
    let particle = |k: usize| Quantity::Mass(plain.particle_at(k).expect("a particle"));
    let gravity = Quantity::Force(plain.force_at(0).expect("gravity"), "acceleration".into(), 1);
    let quantities = [10, 30, 50, 70, 90].map(rod).into_iter().chain([20, 40, 60, 80].map(particle)).chain([gravity]);
    let mut values = Vec::new();
    for (k, quantity) in quantities.enumerate() {
        let value = *builder.number(&quantity).ok_or("no such number")?;
        builder.parameter(Parameter::new(format!("a{k}"), value))?;
        builder.depends(quantity, &format!("a{k}"))?;
        values.push(1.01 * value);
    }
    Ok((builder.build()?.0, values))
}

/// The function whose instructions are counted: callgrind is told to collect inside it only.
#[inline(never)]
fn counted(kernel: &mut dyn FnMut() -> Result<(), StepError>) -> Result<(), StepError> {
    kernel()
}

/// Sets one kernel up and runs it once, under callgrind.
///
/// # Errors
/// A name that no kernel has, or an error of the engine.
pub fn run_one(name: &str) -> Result<(), Box<dyn Error>> {
    let found = KERNELS.iter().find(|(known, _)| *known == name);
    let (_, set_up) = found.ok_or_else(|| format!("there is no kernel `{name}`"))?;
    Ok(counted(&mut *set_up()?)?)
}

/// Counts the instructions of every kernel and prints them beside the counts kept in the file; `keep` writes the file
/// anew. Without valgrind it prints a note and compares nothing.
///
/// # Errors
/// A file that cannot be read or written, or output of callgrind without a count.
pub fn compare(baseline: &Path, keep: bool) -> Result<(), Box<dyn Error>> {
    let kept = read(baseline)?;
    let mut csv = String::from("kernel,instructions\n");
    println!("{:<24} {:>14} {:>14} {:>8}", "kernel", "instructions", "kept", "ratio");
    for (name, _) in KERNELS {
        let Some(count) = count(name)? else {
            println!("valgrind is not installed, so no instructions are counted");
            return Ok(());
        };
        let (before, ratio) = match kept.get(name) {
            Some(&before) => (before.to_string(), format!("{:.3}", count as f64 / before as f64)),
            None => ("–".to_owned(), "–".to_owned()),
        };
        println!("{name:<24} {count:>14} {before:>14} {ratio:>8}");
        writeln!(csv, "{name},{count}")?;
    }
    if keep {
        fs::write(baseline, csv)?;
    }
    Ok(())
}

fn read(baseline: &Path) -> Result<BTreeMap<String, u64>, Box<dyn Error>> {
    let text = match fs::read_to_string(baseline) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
        read => read?,
    };
    let pairs = text.lines().skip(1).filter_map(|line| line.split_once(','));
    pairs.map(|(name, count)| Ok((name.to_owned(), count.parse()?))).collect()
}

/// The number of instructions of one kernel, from a run of this program under callgrind; `None` without valgrind.
fn count(name: &str) -> Result<Option<u64>, Box<dyn Error>> {
    let valgrind = Command::new("valgrind")
        .args(["--tool=callgrind", "--toggle-collect=*kernels*counted*", "--callgrind-out-file=/dev/null"])
        .arg(env::current_exe()?)
        .args(["kernel", name])
        .output();
    let output = match valgrind {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        ran => ran?,
    };
    let said = String::from_utf8_lossy(&output.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok());
    collected.map(Some).ok_or_else(|| format!("callgrind counted nothing in {name}:\n{said}").into())
}
