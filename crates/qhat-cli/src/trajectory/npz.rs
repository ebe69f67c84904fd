//! NPZ: a zip with an NPY file for each array, as `numpy.load` reads it, without pickles.
//!
//! An NPY file begins with its shape, and the number of frames is known only at the end, because a run may diverge. So
//! each array grows in a file of its own, and the zip is written at the end.

use super::npy;
use super::target::Target;
use crate::failure::Failure;
use qhat::{System, Terms};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Seek, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// The size from which on a member of a zip gets 64-bit headers [bytes]. Simple readers cannot read such headers, so
/// that smaller members have none.
const WIDE: u64 = u32::MAX as u64 / 2;

/// One array; each frame adds a row.
struct Array {
    name: &'static str,
    /// The shape of one row.
    shape: Vec<usize>,
    file: BufWriter<File>,
}

impl Array {
    fn append(&mut self, numbers: &[f64]) -> io::Result<()> {
        numbers.iter().try_for_each(|number| self.file.write_all(&number.to_le_bytes()))
    }
}

/// A trajectory being written as NPZ.
pub(crate) struct Recorder {
    target: Target,
    frames: usize,
    arrays: [Array; 7],
    names: Vec<(&'static str, Vec<String>)>,
}

impl Recorder {
    pub(super) fn new(target: Target, system: &System) -> Result<Self, Failure> {
        let (n, d, m) = (system.particle_count(), system.dimension(), system.row_count());
        let links: Vec<String> = system.links().map(|link| link.name.to_owned()).collect();
        let array = |name, shape: &[usize]| -> Result<Array, Failure> {
            Ok(Array { name, shape: shape.to_vec(), file: BufWriter::new(target.scratch()?) })
        };
        let arrays = [
            array("t", &[])?,
            array("positions", &[n, d])?,
            array("velocities", &[n, d])?,
            array("constraint_forces", &[n, d])?,
            array("multipliers", &[m])?,
            array("tension", &[links.len()])?,
            array("tension_is_unique", &[links.len()])?,
        ];
        let names = vec![
            ("particle_ids", system.particle_names().to_vec()),
            ("row_names", system.row_names().to_vec()),
            ("link_names", links),
        ];
        Ok(Recorder { target, frames: 0, arrays, names })
    }

    pub(super) fn frame(&mut self, time: f64, terms: &Terms) -> Result<(), Failure> {
        let is_unique = super::as_numbers(&terms.tension_is_unique);
        let rows: [&[f64]; 7] = [
            &[time],
            &terms.positions,
            &terms.velocities,
            &terms.constraint_forces,
            &terms.multipliers,
            &terms.tension,
            &is_unique,
        ];
        self.frames += 1;
        let mut arrays = self.arrays.iter_mut().zip(rows);
        arrays.try_for_each(|(array, row)| array.append(row)).map_err(|error| self.target.cannot_write(&error))
    }

    pub(super) fn finish(self, origin: &str) -> Result<(), Failure> {
        let target = self.target;
        let file = target.temporary()?;
        // The bytes depend on the scene and the settings alone, so that two runs can be compared. They hold no date.
        let options = SimpleFileOptions::DEFAULT.compression_method(CompressionMethod::Stored);
        let pack = || -> io::Result<()> {
            let mut zip = ZipWriter::new(BufWriter::new(file.as_file()));
            for array in self.arrays {
                let shape = [&[self.frames], array.shape.as_slice()].concat();
                let mut numbers = array.file.into_inner()?;
                let wide = numbers.stream_position()? > WIDE;
                numbers.rewind()?;
                zip.start_file(format!("{}.npy", array.name), options.large_file(wide))?;
                zip.write_all(&npy::header(npy::FLOAT64, &shape))?;
                io::copy(&mut BufReader::new(numbers), &mut zip)?;
            }
            for (name, texts) in &self.names {
                zip.start_file(format!("{name}.npy"), options)?;
                zip.write_all(&npy::texts(&[texts.len()], texts))?;
            }
            zip.start_file("origin.npy", options)?;
            zip.write_all(&npy::texts(&[], &[origin]))?;
            zip.finish()?.flush()
        };
        pack().map_err(|error| target.cannot_write(&error))?;
        target.put(file)
    }
}
