//! The times of the frames of a trajectory: t_i = i · duration / N, i = 0 … N.

use crate::failure::Failure;
use qhat::{Settings, SettingsError};
use serde::{Deserialize, Serialize};

/// The most frames of a run. A file with more would have at least a gigabyte even for one particle.
pub(crate) const MOST: f64 = 1e8;

/// The number of frames of about h in a duration \[s\], at least 1.
fn fitting(duration: f64, settings: &Settings) -> f64 {
    (duration / settings.h).round().max(1.0)
}

/// Equal frames over a duration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Frames {
    /// The duration \[s\].
    pub(crate) duration: f64,
    /// N, the number of frames after the start; a trajectory has N + 1 rows.
    pub(crate) count: usize,
    /// t_{i+1} − t_i, the time that is simulated for each frame \[s\].
    pub(crate) length: f64,
}

/// The difference of duration/N and h, relative, that is the rounding of a duration written in decimals. A frame of h
/// has the same length for every duration, so that a longer run begins with the bits of a shorter one.
const ROUNDING: f64 = 1e-12;

impl Frames {
    /// Frames of a duration \[s\]: `count` of them, or else as many as h fits into the duration.
    ///
    /// # Errors
    /// A duration that is not positive and finite, no frames, and too many.
    pub(crate) fn new(duration: f64, count: Option<usize>, settings: &Settings) -> Result<Self, Failure> {
        if !(duration.is_finite() && duration > 0.0) {
            return Err(Failure::input(format!("the duration must be positive and finite, but is {duration} s")));
        }
        let wanted = match count {
            Some(count) => count as f64,
            None => fitting(duration, settings),
        };
        if wanted == 0.0 {
            return Err(Failure::input("a run of 0 frames simulates nothing; ask for one or more with --frames"));
        }
        if wanted > MOST {
            return Err(Failure::input(format!(
                "{wanted:e} frames are more than the {MOST:e} that qhat writes; ask for fewer with --frames"
            )));
        }
        let even = duration / wanted;
        let is_h = (even - settings.h).abs() <= ROUNDING * settings.h;
        Ok(Frames { duration, count: wanted as usize, length: if is_h { settings.h } else { even } })
    }

    /// The same frames over another duration \[s\].
    ///
    /// # Errors
    /// A duration that is not positive and finite, or that is no whole number of frames, in words.
    pub(crate) fn over(self, duration: f64) -> Result<Self, String> {
        if !(duration.is_finite() && duration > 0.0) {
            return Err(format!("the duration must be positive and finite, but is {duration} s"));
        }
        let count = (duration / self.length).round();
        let is_whole = (count * self.length - duration).abs() <= ROUNDING * duration;
        if !is_whole || !(1.0..=MOST).contains(&count) {
            let length = qhat::Seconds(self.length);
            return Err(format!("a duration of {duration} s is no whole number of its frames of {length} s"));
        }
        Ok(Frames { duration, count: count as usize, ..self })
    }

    /// t_i \[s\].
    pub(crate) fn time(&self, index: usize) -> f64 {
        if index == 0 { 0.0 } else { index as f64 * self.duration / self.count as f64 }
    }

    /// `Ok` if a fixed-step integrator can end a step at every frame.
    ///
    /// # Errors
    /// As [`Frames::refused`].
    pub(crate) fn check(&self, settings: &Settings) -> Result<(), Failure> {
        settings.steps_in(self.length).map(|_| ()).map_err(|error| self.refused(&error, settings))
    }

    /// The failure where a fixed-step integrator cannot end a step at a frame.
    pub(crate) fn refused(&self, error: &SettingsError, settings: &Settings) -> Failure {
        Failure::input(format!(
            "{error}\n`{}` takes steps of exactly h, and {} s in {} frames would end between two of them; \
             choose --duration, --frames or --h so that they fit",
            settings.integrator, self.duration, self.count
        ))
    }
}
