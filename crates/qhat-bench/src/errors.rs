//! The errors of a motion, from the positions and velocities at the end of each frame. The motion may come from any
//! engine.
//!
//! ```text
//! length error of a rod   | |x_a − x_b| − r | / r
//! energy error            (T + V − V at the start) / largest T over the frames
//! ```

use crate::workload::Workload;
use qhat::larger;

/// Length and energy errors of a motion, frame by frame.
#[derive(Clone, Debug, Default)]
pub struct Errors {
    /// The largest relative length error of any rod at any frame.
    pub worst_length: f64,
    sum_of_squares: f64,
    lengths: usize,
    start: Option<f64>,
    missing: f64,
    largest_missing: f64,
    largest_kinetic: f64,
}

impl Errors {
    /// The errors of a motion that starts at the positions of the workload, at rest.
    pub fn of(workload: &Workload) -> Self {
        let start = potential(workload, &workload.positions);
        Errors { start: Some(start), ..Errors::default() }
    }

    /// Adds one frame: positions \[m\] and velocities \[m/s\], d·n numbers each.
    pub fn frame(&mut self, workload: &Workload, positions: &[f64], velocities: &[f64]) {
        let d = workload.dimension;
        for (a, b, length) in workload.rods() {
            let square = |k: usize| (positions[a * d + k] - positions[b * d + k]).powi(2);
            let error = ((0..d).map(square).sum::<f64>().sqrt() - length).abs() / length;
            self.worst_length = larger(self.worst_length, error);
            self.sum_of_squares += error * error;
        }
        self.lengths += workload.lengths.len();
        let kinetic = kinetic(workload, velocities);
        self.missing = kinetic + potential(workload, positions) - self.start.unwrap_or_default();
        self.largest_kinetic = larger(self.largest_kinetic, kinetic);
        self.largest_missing = larger(self.largest_missing, self.missing.abs());
    }

    /// Root mean square of all relative length errors at all frames.
    pub fn rms_length(&self) -> f64 {
        (self.sum_of_squares / self.lengths.max(1) as f64).sqrt()
    }

    /// The energy error of the last frame, relative to the largest kinetic energy; negative if energy was lost.
    pub fn energy(&self) -> f64 {
        self.missing / self.largest_kinetic
    }

    /// The largest energy error of any frame in size, relative to the largest kinetic energy.
    pub fn energy_max(&self) -> f64 {
        self.largest_missing / self.largest_kinetic
    }
}

fn kinetic(workload: &Workload, velocities: &[f64]) -> f64 {
    let of = |(i, v): (usize, &[f64])| {
        let square: f64 = v.iter().map(|v| v * v).sum();
        if workload.fixed[i] == 1 { 0.0 } else { 0.5 * workload.masses[i] * square }
    };
    velocities.chunks_exact(workload.dimension).enumerate().map(of).sum()
}

fn potential(workload: &Workload, positions: &[f64]) -> f64 {
    let of = |(x, mass): (&[f64], &f64)| -mass * x.iter().zip(&workload.gravity).map(|(x, g)| x * g).sum::<f64>();
    positions.chunks_exact(workload.dimension).zip(&workload.masses).map(of).sum()
}
