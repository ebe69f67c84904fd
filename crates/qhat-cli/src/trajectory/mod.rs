//! Trajectories on disk: each frame adds one row to every array. The output gets its name when it is complete.

mod csv;
mod events;
mod npy;
mod npz;
mod quantity;
mod stored;
mod target;

pub(crate) use quantity::{Frame, Quantity, Subjects, selection};
pub(crate) use stored::Stored;
pub(crate) use target::Target;

use crate::failure::Failure;
use crate::output::ending;
use qhat::Event;
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

/// The frames of a trajectory that are in its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kept {
    /// All frames.
    Whole,
    /// The first frames, as many as fit on the disk.
    Part,
    /// Those of an earlier file of this run, because not all fit on the disk.
    Earlier,
}

/// The snapshot and the events, which a trajectory keeps beside its frames.
#[derive(Clone, Copy)]
pub(crate) struct Extras<'a> {
    /// The bytes from which the run goes on, if it can.
    pub(crate) snapshot: Option<&'a [u8]>,
    pub(crate) events: &'a [Event],
}

/// A trajectory being written.
pub(crate) enum Recorder {
    Npz(npz::Recorder),
    Csv(Box<csv::Recorder>),
}

impl Recorder {
    /// Opens temporary files beside the target.
    pub(crate) fn new(target: Target, subjects: Subjects<'_>, quantities: Vec<Quantity>) -> Result<Self, Failure> {
        Ok(match target.format() {
            Format::Npz => Recorder::Npz(npz::Recorder::new(target, subjects, &quantities)?),
            Format::Csv => Recorder::Csv(Box::new(csv::Recorder::new(target, subjects, quantities)?)),
        })
    }

    /// Adds a frame.
    pub(crate) fn frame(&mut self, frame: &Frame) -> Result<(), Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.frame(frame),
            Recorder::Csv(recorder) => recorder.frame(frame),
        }
    }

    /// Takes the frames of a former trajectory.
    pub(crate) fn take(&mut self, former: &mut Stored<'_>) -> Result<(), Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.take(former),
            Recorder::Csv(_) => Err(Failure::input("a run goes on in a file that ends in .npz")),
        }
    }

    /// Puts a file with the frames so far in place, and goes on.
    pub(crate) fn checkpoint(&mut self, origin: &str, extras: Extras<'_>) -> Result<(), Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.checkpoint(origin, extras),
            Recorder::Csv(_) => Err(Failure::input("checkpoints are written to a file that ends in .npz")),
        }
    }

    /// Puts the finished files in place, with the origin, a line of JSON: `whole` with all frames, or `part` where the
    /// last frames could not be written. An NPZ keeps the snapshot.
    pub(crate) fn finish(self, whole: &str, part: &str, extras: Extras<'_>) -> Result<Kept, Failure> {
        match self {
            Recorder::Npz(recorder) => recorder.finish(whole, part, extras),
            Recorder::Csv(recorder) => recorder.finish(whole, part, extras.events),
        }
    }
}
