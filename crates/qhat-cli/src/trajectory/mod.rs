//! Trajectories on disk: each frame adds one row to every array. The output gets its name when it is complete.

mod csv;
mod npy;
mod npz;
pub(crate) mod stored;
mod target;

pub(crate) use target::Target;

use crate::failure::Failure;
use crate::output::ending;
use qhat::{System, Terms};
use std::path::Path;

/// The format of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// Arrays for NumPy.
    Npz,
    /// One line a frame.
    Csv,
}

impl Format {
    /// The format that the ending of a file name stands for.
    ///
    /// # Errors
    /// Another ending.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        match ending(path).as_deref() {
            Some("npz") => Ok(Format::Npz),
            Some("csv") => Ok(Format::Csv),
            _ => Err(Failure::input(format!(
                "cannot tell from its ending how to write `{}`; end the name in .npz (NumPy arrays) or .csv",
                path.display()
            ))),
        }
    }
}

/// 1 for true and 0 for false: every array of a trajectory holds numbers.
fn as_numbers(flags: &[bool]) -> Vec<f64> {
    flags.iter().map(|&flag| f64::from(u8::from(flag))).collect()
}

/// The frames of a trajectory that are in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// All frames.
    Whole,
    /// The first frames, as many as fit on the disk.
    Part,
}

/// A trajectory being written.
pub(crate) enum Recorder {
    Npz(npz::Recorder),
    Csv(Box<csv::Recorder>),
}

impl Recorder {
    /// Opens temporary files beside the target.
    pub(crate) fn new(target: Target, system: &System) -> Result<Self, Failure> {
        match target.format() {
            Format::Npz => npz::Recorder::new(target, system).map(Recorder::Npz),
            Format::Csv => csv::Recorder::new(target, system).map(|recorder| Recorder::Csv(Box::new(recorder))),
        }
    }

    /// Adds a frame: t \[s\] and everything evaluated there.
    pub(crate) fn frame(&mut self, time: f64, terms: &Terms) -> Result<(), Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.frame(time, terms),
            Recorder::Csv(recorder) => recorder.frame(time, terms),
        }
    }

    /// Puts the finished files in place, with the origin, a line of JSON: `whole` with all frames, or `part` where the
    /// last frames could not be written.
    pub(crate) fn finish(self, whole: &str, part: &str) -> Result<Kept, Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.finish(whole, part),
            Recorder::Csv(recorder) => recorder.finish(whole, part),
        }
    }
}
