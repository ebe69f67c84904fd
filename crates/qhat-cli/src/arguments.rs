//! The commands, arguments and options of the command line.

use crate::trajectory::Quantity;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueHint};
use qhat::Integrator;
use qhat_shapes::Options;
use std::path::PathBuf;

const EXIT_CODES: &str = "Exit codes:
  0  done
  1  the motion diverged, or the constraints cannot all hold; the frames reached are written, the output is marked
  2  bad input, and nothing is written; or a full disk, and the frames that fit are written, the output is marked
  130  interrupted, with Ctrl-C, SIGTERM or SIGHUP; the frames reached are written, the output is marked";

/// Exact dynamics of particles and constraints, with the tension in every rod and rope.
#[derive(Debug, Parser)]
#[command(name = "qhat", version, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate a scene; write its trajectory and a summary
    Run(Run),
    /// Draw a still of a scene, of any time of its run, or of a frame of a trajectory
    Render(Render),
    /// Report the errors of a scene, or its degrees of freedom and rank
    Check(Check),
    /// Open a scene in the browser
    Play(Play),
    /// List the scenes that come with qhat, or print one of them
    Scenes(Scenes),
    /// Measure the cost and the errors of known workloads on this machine
    Bench(Bench),
    /// Print the JSON Schema of scene files
    Schema,
    /// Print a completion script for a shell
    Completions {
        /// The shell that reads the script
        shell: clap_complete::Shell,
    },
}

/// The options that a run which goes on keeps from before.
const KEPT: [&str; 8] = ["set", "select", "frames", "h", "integrator", "tolerance", "max_substeps", "no_tension"];

/// Values of parameters.
#[derive(Args, Debug)]
pub(crate) struct Parameters {
    /// Give a parameter of the scene another value; may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parameter)]
    pub(crate) set: Vec<(String, f64)>,
}

/// A name and a value, as in a=0.2.
fn parameter(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("a parameter is set as in a=0.2")?;
    let number = value.trim().parse().map_err(|_| format!("`{value}` is no number, as 0.2 and 1e-3 are"))?;
    let name = name.trim();
    if name.is_empty() { Err("a name stands before the =, as in a=0.2".into()) } else { Ok((name.to_owned(), number)) }
}

#[derive(Args, Debug)]
pub(crate) struct Run {
    /// A scene file (.toml or .json), the name of a scene that comes with qhat, or - for stdin
    #[arg(value_hint = ValueHint::FilePath, required_unless_present = "from")]
    pub(crate) scene: Option<String>,

    #[command(flatten)]
    pub(crate) parameters: Parameters,

    /// Go on from this trajectory (.npz) of a run that ended, was interrupted or was killed, as if it had not stopped;
    /// the output replaces it unless -o names another file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = KEPT)]
    pub(crate) from: Option<PathBuf>,

    /// Write these quantities of every frame, as in positions,energy; all writes every one [default: t, positions,
    /// velocities, constraint_forces, multipliers, tension, tension_is_unique]
    #[arg(long, value_name = "NAMES", requires = "output", value_parser = selection)]
    pub(crate) select: Option<Selection>,

    /// Write the trajectory so far every so many seconds of real time, as 30s, or every so many frames, as 100frames:
    /// `--from` goes on from it after a crash
    #[arg(long, value_name = "INTERVAL", value_parser = interval)]
    pub(crate) checkpoint: Option<Interval>,

    /// Write the trajectory to this file, whose ending gives the format: .npz (NumPy) or .csv
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: Option<PathBuf>,

    /// Replace an output that exists
    #[arg(long, requires = "output")]
    pub(crate) force: bool,

    /// The time to simulate [s], in place of the scene's duration
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(crate) duration: Option<f64>,

    /// The number of frames in the duration; the start is written as one more [default: duration / h]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) frames: Option<usize>,

    /// The step, or the frame of an integrator that chooses its own steps [s], in place of the scene's h
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(crate) h: Option<f64>,

    /// The integrator, in place of the scene's
    #[arg(long, value_name = "NAME", value_parser = integrator_parser())]
    pub(crate) integrator: Option<Integrator>,

    /// The relative error of a substep that adaptive integrators aim at, in place of the scene's
    #[arg(long, value_name = "NUMBER", allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,

    /// The most substeps that an adaptive integrator may take in a frame, in place of the scene's
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub(crate) max_substeps: Option<usize>,

    /// Leave out the largest tension, which costs one more solve for each substep
    #[arg(long)]
    pub(crate) no_tension: bool,

    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,

    /// Show no progress bar, and print no summary without --json
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Render {
    /// A scene file (.toml or .json), the name of a scene that comes with qhat, or - for stdin
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: String,

    #[command(flatten)]
    pub(crate) parameters: Parameters,

    /// Write the picture to this file, whose ending gives the format: .svg or .png
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) output: PathBuf,

    /// Replace an output that exists
    #[arg(long)]
    pub(crate) force: bool,

    /// Simulate to this time [s] and draw the state there [default: 0, the start]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(crate) at: Option<f64>,

    /// Draw a frame of this trajectory of the scene (.npz), as `qhat run -o` writes it, and simulate nothing
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with_all = ["at", "set"])]
    pub(crate) from: Option<PathBuf>,

    /// The frame of the trajectory, counted from 0 [default: the last]
    #[arg(long, value_name = "K", requires = "from")]
    pub(crate) frame: Option<u64>,

    /// Width and height of the picture [px]
    #[arg(long, value_name = "WxH", default_value = "1200x800", value_parser = picture_size)]
    pub(crate) size: [u32; 2],

    /// Draw light strokes on a dark background
    #[arg(long)]
    pub(crate) dark: bool,

    /// Show no progress bar
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// The quantities of a trajectory.
pub(crate) type Selection = std::sync::Arc<[Quantity]>;

fn selection(text: &str) -> Result<Selection, String> {
    crate::trajectory::selection(text).map(Into::into)
}

/// The time from one checkpoint to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Interval {
    /// Seconds of real time.
    Seconds(f64),
    Frames(usize),
}

/// An interval, as in 30s or 100frames.
fn interval(text: &str) -> Result<Interval, String> {
    let wrong = || format!("an interval is written as in 30s or 100frames, and is above 0, not `{text}`");
    let (text, frames) = match (text.strip_suffix("frames").or(text.strip_suffix("frame")), text.strip_suffix('s')) {
        (Some(frames), _) => (frames, true),
        (None, Some(seconds)) => (seconds, false),
        (None, None) => return Err(wrong()),
    };
    if frames {
        text.trim().parse().ok().filter(|&frames| frames > 0).map(Interval::Frames).ok_or_else(wrong)
    } else {
        let seconds = text.trim().parse().ok().filter(|seconds: &f64| *seconds > 0.0 && seconds.is_finite());
        seconds.map(Interval::Seconds).ok_or_else(wrong)
    }
}

/// Width and height, as in 1200x800.
fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let (least, most) = (Options::LEAST, Options::MOST);
    let sides = text.split_once(['x', '×']).ok_or("a size is written as in 1200x800")?;
    let side = |text: &str| match text.parse() {
        Ok(side) if (least..=most).contains(&side) => Ok(side),
        _ => Err(format!("width and height are whole numbers from {least} to {most}, not `{text}`")),
    };
    Ok([side(sides.0)?, side(sides.1)?])
}

#[derive(Args, Debug)]
pub(crate) struct Check {
    /// A scene file (.toml or .json), the name of a scene that comes with qhat, or - for stdin
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: String,

    #[command(flatten)]
    pub(crate) parameters: Parameters,

    /// Print the findings as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Play {
    /// A scene file (.toml or .json), the name of a scene that comes with qhat, or - for stdin
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: Option<String>,

    #[command(flatten)]
    pub(crate) parameters: Parameters,

    /// The port to listen on, on 127.0.0.1 only [default: 7407, or the next that is free]
    #[arg(long, value_name = "PORT")]
    pub(crate) port: Option<u16>,

    /// Print the address and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Scenes {
    /// Print the text of this scene
    pub(crate) name: Option<String>,

    /// Print the list as JSON
    #[arg(long, conflicts_with = "name")]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct Bench {
    /// Workloads such as chain100, heavy1000, net32, cloth32, truss20, truss20r, four-bar, star1000, many20
    /// [default: all]
    #[arg(value_name = "WORKLOAD")]
    pub(crate) workloads: Vec<String>,

    /// One integrator and tolerance, as in dop853:1e-4 [default: several of each]
    #[arg(long, value_name = "SETTING")]
    pub(crate) setting: Option<String>,

    /// Write the numbers to this file, too, which must not exist
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) csv: Option<PathBuf>,

    /// The CPU time after which a run stops at the end of its frame [s]
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, allow_negative_numbers = true)]
    pub(crate) limit: f64,
}

/// Accepts the names of the integrators, and lists them in the help.
fn integrator_parser() -> impl TypedValueParser<Value = Integrator> {
    PossibleValuesParser::new(Integrator::names().map(|(name, _)| name)).try_map(|name| name.parse::<Integrator>())
}
