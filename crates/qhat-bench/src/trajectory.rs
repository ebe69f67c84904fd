//! The file of trajectories that every engine writes: for each frame the positions \[m\] and then the velocities
//! \[m/s\] of all particles, d·n numbers each, as little-endian f64 and nothing else.

use crate::errors::Errors;
use crate::workload::Workload;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes a trajectory frame by frame.
#[derive(Debug)]
pub struct Writer(BufWriter<File>);

impl Writer {
    /// Creates a file; an existing file is replaced.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn create(path: &Path) -> io::Result<Self> {
        Ok(Writer(BufWriter::new(File::create(path)?)))
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn frame(&mut self, positions: &[f64], velocities: &[f64]) -> io::Result<()> {
        positions.iter().chain(velocities).try_for_each(|number| self.0.write_all(&number.to_le_bytes()))
    }

    /// Completes the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// Measures the errors of a trajectory. Returns the number of complete frames, too.
///
/// # Errors
/// A file that cannot be read.
pub fn measure(workload: &Workload, path: &Path) -> io::Result<(usize, Errors)> {
    let numbers: Vec<f64> = fs::read(path)?.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let coordinates = workload.positions.len();
    let mut errors = Errors::of(workload);
    let mut frames = 0;
    for frame in numbers.chunks_exact(2 * coordinates) {
        errors.frame(workload, &frame[..coordinates], &frame[coordinates..]);
        frames += 1;
    }
    Ok((frames, errors))
}
