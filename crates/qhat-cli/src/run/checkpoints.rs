//! Checkpoints: when the trajectory so far is written.

use crate::arguments::Interval;
use crate::failure::{Failure, warn};
use std::time::{Duration, Instant};

/// The interval between checkpoints, and the frames and the time since the last one.
pub(super) struct Checkpoints {
    interval: Interval,
    last: Instant,
    frames: usize,
    has_failed: bool,
}

impl Checkpoints {
    pub(super) fn new(interval: Interval) -> Self {
        Checkpoints { interval, last: Instant::now(), frames: 0, has_failed: false }
    }

    /// Counts a frame; whether a checkpoint is due after it.
    pub(super) fn are_due(&mut self) -> bool {
        self.frames += 1;
        match self.interval {
            Interval::Frames(frames) => self.frames >= frames,
            Interval::Seconds(seconds) => {
                self.last.elapsed() >= Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
            }
        }
    }

    /// Begins the next interval, after a checkpoint was written: writing takes no part of it.
    pub(super) fn begin(&mut self) {
        (self.frames, self.last) = (0, Instant::now());
    }

    /// Tells once that a checkpoint could not be written.
    pub(super) fn failed(&mut self, failure: &Failure) {
        if !self.has_failed {
            warn(format!("no checkpoint: {}; the run goes on, and tries again", failure.message()));
        }
        self.has_failed = true;
    }
}
