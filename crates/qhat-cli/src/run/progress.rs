//! The progress bar on stderr, shown at a terminal only. It has no colours, so that `NO_COLOR` needs no handling.

use super::frames::Frames;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal};

const TEMPLATE: &str = "{wide_bar} {percent:>3} %  {msg}  {eta} to go";

/// The progress of a run.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// A bar over the frames; hidden with `quiet`, and where stderr is no terminal.
    pub(crate) fn new(frames: Frames, quiet: bool) -> Self {
        if quiet || !io::stderr().is_terminal() {
            return Progress(ProgressBar::hidden());
        }
        let style = ProgressStyle::with_template(TEMPLATE).unwrap_or_else(|_| ProgressStyle::default_bar());
        Progress(ProgressBar::new(frames.count as u64).with_style(style))
    }

    /// Shows that the frame `index` at a time \[s\] is done.
    pub(crate) fn at(&self, index: usize, time: f64) {
        if self.0.is_hidden() {
            return;
        }
        self.0.set_message(format!("t = {time:.2} s"));
        self.0.set_position(index as u64);
    }

    /// Clears the line of the bar.
    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
