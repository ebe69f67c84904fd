//! NPZ: a zip with an NPY file for each array, as `numpy.load` reads it, without pickles.
//!
//! An NPY file begins with its shape, and the number of frames is known only at the end, because a run may diverge. So
//! each array grows in a file of its own, and the zip is written at the end. On a full disk the first frames are kept,
//! as many as fit.

use super::Kept;
use super::npy;
use super::target::Target;
use crate::failure::Failure;
use qhat::{System, Terms};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Seek, SeekFrom, Write};
use tempfile::NamedTempFile;
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

    /// The bytes of one row.
    fn row(&self) -> u64 {
        8 * self.shape.iter().product::<usize>() as u64
    }

    /// Gives up what is not on the disk yet. Returns the number of whole rows there; none where rows have no bytes.
    fn give_up(self) -> io::Result<(Self, Option<u64>)> {
        let row = self.row();
        let Array { name, shape, file } = self;
        let (file, _) = file.into_parts();
        let whole = file.metadata()?.len().checked_div(row);
        Ok((Array { name, shape, file: BufWriter::new(file) }, whole))
    }

    /// Shortens the file to so many rows.
    fn cut(&mut self, rows: u64) -> io::Result<()> {
        self.file.get_ref().set_len(rows * self.row())?;
        self.file.seek(SeekFrom::End(0)).map(|_| ())
    }
}

/// A trajectory being written as NPZ.
pub(crate) struct Recorder {
    target: Target,
    frames: usize,
    arrays: Vec<Array>,
    names: Vec<(&'static str, Vec<String>)>,
}

impl Recorder {
    pub(super) fn new(target: Target, system: &System) -> Result<Self, Failure> {
        let (n, d, m) = (system.particle_count(), system.dimension(), system.row_count());
        let links: Vec<String> = system.links().map(|link| link.name.to_owned()).collect();
        let array = |name, shape: &[usize]| -> Result<Array, Failure> {
            Ok(Array { name, shape: shape.to_vec(), file: BufWriter::new(target.scratch()?) })
        };
        let arrays = vec![
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
        let mut arrays = self.arrays.iter_mut().zip(rows);
        match arrays.try_for_each(|(array, row)| array.append(row)) {
            Ok(()) => {
                self.frames += 1;
                Ok(())
            }
            Err(error) => {
                let failure = self.target.cannot_write(&error);
                self.keep_whole_frames().map_err(|error| self.target.cannot_write(&error))?;
                Err(failure)
            }
        }
    }

    /// Shortens all arrays to the frames that are whole on the disk.
    fn keep_whole_frames(&mut self) -> io::Result<()> {
        let mut frames = self.frames as u64;
        let mut arrays = Vec::new();
        for array in std::mem::take(&mut self.arrays) {
            let (array, whole) = array.give_up()?;
            frames = frames.min(whole.unwrap_or(frames));
            arrays.push(array);
        }
        self.arrays = arrays;
        self.cut(frames as usize)
    }

    fn cut(&mut self, frames: usize) -> io::Result<()> {
        self.frames = frames;
        self.arrays.iter_mut().try_for_each(|array| array.cut(frames as u64))
    }

    /// Packs the arrays. On a full disk the last half of the frames is given up, again and again, until the rest fits.
    pub(super) fn finish(mut self, whole: &str, part: &str) -> Result<Kept, Failure> {
        let mut kept = Kept::Whole;
        if self.arrays.iter_mut().try_for_each(|array| array.file.flush()).is_err() {
            self.keep_whole_frames().map_err(|error| self.target.cannot_write(&error))?;
            kept = Kept::Part;
        }
        loop {
            match self.pack(if kept == Kept::Whole { whole } else { part }) {
                Ok(file) => return self.target.put(file).map(|()| kept),
                Err(error) if self.frames <= 1 || error.kind() != io::ErrorKind::StorageFull => {
                    return Err(self.target.cannot_write(&error));
                }
                Err(_) => {
                    let half = self.frames.div_ceil(2);
                    self.cut(half).map_err(|error| self.target.cannot_write(&error))?;
                    kept = Kept::Part;
                }
            }
        }
    }

    fn pack(&mut self, origin: &str) -> io::Result<NamedTempFile> {
        let file = self.target.temporary_file()?;
        let mut zip = ZipWriter::new(BufWriter::new(file.as_file()));
        if let Err(error) = self.fill(&mut zip, origin) {
            // A zip that is dropped before its end tries to write that, and prints the error.
            std::mem::forget(zip);
            return Err(error);
        }
        zip.finish()?.flush()?;
        Ok(file)
    }

    /// Writes all members of the zip, up to its list of members.
    fn fill(&mut self, zip: &mut ZipWriter<BufWriter<&File>>, origin: &str) -> io::Result<()> {
        // The bytes depend on the scene and the settings alone, so that two runs can be compared. They hold no date.
        let options = SimpleFileOptions::DEFAULT.compression_method(CompressionMethod::Stored);
        for array in &mut self.arrays {
            let shape = [&[self.frames], array.shape.as_slice()].concat();
            let numbers = array.file.get_mut();
            let wide = numbers.metadata()?.len() > WIDE;
            numbers.rewind()?;
            zip.start_file(format!("{}.npy", array.name), options.large_file(wide))?;
            zip.write_all(&npy::header(npy::FLOAT64, &shape))?;
            io::copy(&mut BufReader::new(numbers), zip)?;
        }
        for (name, texts) in &self.names {
            zip.start_file(format!("{name}.npy"), options)?;
            zip.write_all(&npy::texts(&[texts.len()], texts))?;
        }
        zip.start_file("origin.npy", options)?;
        zip.write_all(&npy::texts(&[], &[origin]))?;
        zip.flush()
    }
}
