//! NPZ: a zip with an NPY file for each array, as `numpy.load` reads it, without pickles.
//!
//! An NPY file begins with its shape, and the number of frames is known only at the end, because a run may diverge. So
//! each array grows in a file of its own, and the zip is written at the end. On a full disk the first frames are kept,
//! as many as fit.

use super::events::speed;
use super::npy;
use super::quantity::{Frame, Quantity, Subjects};
use super::stored::Stored;
use super::target::Target;
use super::{Extras, Kept};
use crate::failure::Failure;
use qhat::Event;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use tempfile::NamedTempFile;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// The size from which on a member of a zip gets 64-bit headers [bytes]. Simple readers cannot read such headers, so
/// that smaller members have none.
const WIDE: u64 = u32::MAX as u64 / 2;

/// One array; each frame adds a row.
struct Array {
    quantity: Quantity,
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
        let Array { quantity, shape, file } = self;
        let (file, _) = file.into_parts();
        let whole = file.metadata()?.len().checked_div(row);
        Ok((Array { quantity, shape, file: BufWriter::new(file) }, whole))
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
    /// The mass of each particle [kg]; infinite where the particle is fixed.
    masses: Vec<f64>,
    /// Whether the target is an earlier file of this run, which a shorter one must not replace.
    has_earlier: bool,
    /// Whether a frame did not fit on the disk.
    is_cut: bool,
}

impl Recorder {
    pub(super) fn new(target: Target, subjects: Subjects<'_>, quantities: &[Quantity]) -> Result<Self, Failure> {
        let system = subjects.system;
        let array = |&quantity: &Quantity| -> Result<Array, Failure> {
            Ok(Array { quantity, shape: quantity.shape(subjects), file: BufWriter::new(target.scratch()?) })
        };
        let arrays = quantities.iter().map(array).collect::<Result<Vec<_>, _>>()?;
        let mut names = vec![
            ("particle_ids", system.particle_names().to_vec()),
            ("row_names", system.row_names().to_vec()),
            ("link_names", system.links().map(|link| link.name.to_owned()).collect()),
        ];
        for own in quantities.iter().filter_map(|quantity| quantity.names(subjects)) {
            if !names.iter().any(|(name, _)| *name == own.0) {
                names.push(own);
            }
        }
        let masses = system.inverse_masses().iter().map(|w| 1.0 / w);
        let masses =
            masses.zip(system.masses()).map(|(inverse, &mass)| if inverse.is_finite() { mass } else { inverse });
        let masses = masses.collect();
        Ok(Recorder { target, frames: 0, arrays, names, masses, has_earlier: false, is_cut: false })
    }

    /// Takes the frames of a former trajectory.
    pub(super) fn take(&mut self, former: &mut Stored<'_>) -> Result<(), Failure> {
        for array in &mut self.arrays {
            let width = array.shape.iter().product::<usize>() as u64;
            former.copy(array.quantity.name(), width, &mut array.file)?;
        }
        self.frames = former.frames()? as usize;
        let [from, to] = [former.path(), self.target.path()].map(std::fs::canonicalize);
        self.has_earlier = from.is_ok_and(|from| to.is_ok_and(|to| from == to));
        Ok(())
    }

    /// Puts a file with the frames so far in place, and goes on.
    pub(super) fn checkpoint(&mut self, origin: &str, extras: Extras<'_>) -> Result<(), Failure> {
        let flushed = self.arrays.iter_mut().try_for_each(|array| array.file.flush());
        let packed = flushed.and_then(|()| self.pack(origin, extras));
        // The next row goes to the end of each array, also after a file that did not fit.
        let at_the_end = self.arrays.iter_mut().try_for_each(|array| array.file.seek(SeekFrom::End(0)).map(|_| ()));
        let file =
            packed.and_then(|file| at_the_end.map(|()| file)).map_err(|error| self.target.cannot_write(&error))?;
        self.target.put(file)?;
        self.has_earlier = true;
        Ok(())
    }

    pub(super) fn frame(&mut self, frame: &Frame) -> Result<(), Failure> {
        let mut arrays = self.arrays.iter_mut();
        match arrays.try_for_each(|array| array.append(&array.quantity.row(frame))) {
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
        self.is_cut = true;
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

    /// Packs the arrays. On a full disk an earlier file of this run stays. Where there is none, the last half of the
    /// frames is given up, again and again, until the rest fits.
    pub(super) fn finish(mut self, whole: &str, part: &str, extras: Extras<'_>) -> Result<Kept, Failure> {
        if self.arrays.iter_mut().try_for_each(|array| array.file.flush()).is_err() {
            self.keep_whole_frames().map_err(|error| self.target.cannot_write(&error))?;
        }
        loop {
            if self.is_cut && self.has_earlier {
                return Ok(Kept::Earlier);
            }
            let (origin, extras) = if self.is_cut { (part, self.shortened(extras)) } else { (whole, extras) };
            match self.pack(origin, extras) {
                Ok(file) => {
                    self.target.put(file)?;
                    return Ok(if self.is_cut { Kept::Part } else { Kept::Whole });
                }
                Err(error) if self.frames <= 1 || error.kind() != io::ErrorKind::StorageFull => {
                    return Err(self.target.cannot_write(&error));
                }
                Err(_) => {
                    self.is_cut = true;
                    let half = self.frames.div_ceil(2);
                    self.cut(half).map_err(|error| self.target.cannot_write(&error))?;
                }
            }
        }
    }

    /// The events up to the last frame. There is no snapshot, which would belong to a later frame.
    fn shortened<'a>(&mut self, extras: Extras<'a>) -> Extras<'a> {
        let last = self.last_time().unwrap_or(f64::INFINITY);
        let count = extras.events.partition_point(|event| event.time <= last);
        Extras { snapshot: None, events: &extras.events[..count] }
    }

    /// t of the last frame \[s\]. Every trajectory begins with the times.
    fn last_time(&mut self) -> io::Result<f64> {
        let times = self.arrays.first_mut().ok_or(io::ErrorKind::NotFound)?.file.get_mut();
        let mut bytes = [0; 8];
        times.seek(SeekFrom::End(-8))?;
        times.read_exact(&mut bytes)?;
        Ok(f64::from_le_bytes(bytes))
    }

    fn pack(&mut self, origin: &str, extras: Extras<'_>) -> io::Result<NamedTempFile> {
        let file = self.target.temporary_file()?;
        let mut zip = ZipWriter::new(BufWriter::new(file.as_file()));
        if let Err(error) = self.fill(&mut zip, origin, extras) {
            // A zip that is dropped before its end tries to write that, and prints the error.
            std::mem::forget(zip);
            return Err(error);
        }
        zip.finish()?.flush()?;
        Ok(file)
    }

    /// Writes all members of the zip, up to its list of members.
    fn fill(&mut self, zip: &mut ZipWriter<BufWriter<&File>>, origin: &str, extras: Extras<'_>) -> io::Result<()> {
        // The bytes depend on the scene and the settings alone, so that two runs can be compared. They hold no date.
        let options = SimpleFileOptions::DEFAULT.compression_method(CompressionMethod::Stored);
        for array in &mut self.arrays {
            let shape = [&[self.frames], array.shape.as_slice()].concat();
            let numbers = array.file.get_mut();
            let wide = numbers.metadata()?.len() > WIDE;
            numbers.rewind()?;
            zip.start_file(format!("{}.npy", array.quantity.name()), options.large_file(wide))?;
            zip.write_all(&npy::header(npy::FLOAT64, &shape))?;
            io::copy(&mut BufReader::new(numbers), zip)?;
        }
        for (name, texts) in &self.names {
            zip.start_file(format!("{name}.npy"), options)?;
            zip.write_all(&npy::texts(&[texts.len()], texts))?;
        }
        zip.start_file("masses.npy", options)?;
        zip.write_all(&npy::numbers(&self.masses))?;
        for (name, bytes) in event_arrays(extras.events) {
            zip.start_file(format!("{name}.npy"), options)?;
            zip.write_all(&bytes)?;
        }
        if let Some(bytes) = extras.snapshot {
            zip.start_file("snapshot.npy", options)?;
            zip.write_all(&npy::header(npy::BYTE, &[bytes.len()]))?;
            zip.write_all(bytes)?;
        }
        zip.start_file("origin.npy", options)?;
        zip.write_all(&npy::texts(&[], &[origin]))?;
        zip.flush()
    }
}

/// The arrays of the events: when, of which constraint, of which kind, how fast [m/s] and how hard [N·s].
fn event_arrays(events: &[Event]) -> [(&'static str, Vec<u8>); 5] {
    let numbers = |of: &dyn Fn(&Event) -> f64| npy::numbers(&events.iter().map(of).collect::<Vec<f64>>());
    let texts =
        |of: &dyn Fn(&Event) -> String| npy::texts(&[events.len()], &events.iter().map(of).collect::<Vec<String>>());
    [
        ("event_t", numbers(&|event| event.time)),
        ("event_constraint", texts(&|event| event.constraint.clone())),
        ("event_kind", texts(&|event| event.kind.name().to_owned())),
        ("event_speed", numbers(&speed)),
        ("event_impulse", numbers(&|event| event.impulse)),
    ]
}
