//! Reads a trajectory back from NPZ: one frame, all rows of an array, the snapshot of the run.

use super::quantity::Quantity;
use crate::failure::Failure;
use npyz::{NpyFile, NpyHeader, Order};
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;
use zip::ZipArchive;

/// The most bytes of the origin that are read. The origin is a line of JSON of about a thousand bytes.
const LARGEST_ORIGIN: u64 = 1 << 20;

/// A trajectory on disk, open for reading.
pub(crate) struct Stored<'a> {
    path: &'a Path,
    archive: ZipArchive<BufReader<File>>,
}

impl<'a> Stored<'a> {
    pub(crate) fn open(path: &'a Path) -> Result<Self, Failure> {
        let name = path.display();
        let file = File::open(path).map_err(|error| Failure::io(format!("cannot read `{name}`"), &error))?;
        let archive = ZipArchive::new(BufReader::new(file));
        let archive = archive.map_err(|error| {
            Failure::input(format!("`{name}` is no trajectory that `qhat run -o run.npz` writes: {error}"))
        })?;
        Ok(Stored { path, archive })
    }

    pub(crate) fn path(&self) -> &'a Path {
        self.path
    }

    /// The number of frames.
    pub(crate) fn frames(&mut self) -> Result<u64, Failure> {
        let shape = self.header("t").map(|(header, _)| header.shape().to_vec());
        let shape = shape.map_err(|error| self.fault("t", &error))?;
        Ok(shape.first().copied().unwrap_or(0))
    }

    /// The `count` numbers of one frame of an array.
    ///
    /// # Errors
    /// No such array or frame, another number of numbers, a number that is not finite.
    pub(crate) fn numbers(&mut self, array: &str, frame: u64, count: usize) -> Result<Vec<f64>, Failure> {
        let frames = self.frames()?;
        self.read(array, (frame, frames), count).map_err(|error| self.fault(array, &error))
    }

    fn read(&mut self, array: &str, (frame, frames): (u64, u64), count: usize) -> io::Result<Vec<f64>> {
        let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        let (header, mut member) = self.header(array)?;
        let [own, row @ ..] = header.shape() else { return Err(wrong("it has no frames".into())) };
        let width = row.iter().try_fold(1u64, |product, &length| product.checked_mul(length));
        if width != Some(count as u64) || header.order() != Order::C {
            return Err(wrong(format!("a frame of it has the shape {row:?}, and the scene needs {count} numbers")));
        }
        if *own != frames {
            return Err(wrong(format!("it has {own} frames, and `t` has {frames}")));
        }
        if frame >= frames {
            return Err(wrong(format!("it has {frames} frames")));
        }
        let skip = frame.checked_mul(8 * count as u64).ok_or_else(|| wrong("it is too large".into()))?;
        io::copy(&mut member.by_ref().take(skip), &mut io::sink())?;
        let numbers = NpyFile::with_header(header, member).data::<f64>().map_err(|error| wrong(error.to_string()))?;
        let numbers = numbers.take(count).collect::<io::Result<Vec<f64>>>()?;
        let finite = numbers.iter().all(|number| number.is_finite());
        if finite { Ok(numbers) } else { Err(wrong(format!("frame {frame} has numbers that are not finite"))) }
    }

    /// The origin as JSON; `None` if the file has none that can be read.
    pub(crate) fn origin(&mut self) -> Option<serde_json::Value> {
        let mut bytes = Vec::new();
        let member = self.archive.by_name("origin.npy").ok()?;
        member.take(LARGEST_ORIGIN).read_to_end(&mut bytes).ok()?;
        let file = NpyFile::new(bytes.as_slice()).ok()?;
        // A text that claims to be longer than the file would ask for memory without end.
        if file.dtype().num_bytes()? > bytes.len() || file.len() != 1 {
            return None;
        }
        serde_json::from_str(file.into_vec::<String>().ok()?.first()?).ok()
    }

    /// The quantities that the trajectory has, in the order of files.
    pub(crate) fn quantities(&self) -> Vec<Quantity> {
        let has = |quantity: &Quantity| self.archive.index_for_name(&format!("{}.npy", quantity.name())).is_some();
        Quantity::ALL.into_iter().filter(has).collect()
    }

    /// The parameters of the run, if it was one of the scene with this hash.
    pub(crate) fn parameters(&mut self, scene_hash: &str) -> Vec<(String, f64)> {
        let origin = self.origin().filter(|origin| origin.get("scene_hash").is_some_and(|hash| hash == scene_hash));
        let table = origin.as_ref().and_then(|origin| origin.get("parameters")?.as_object());
        let pairs = table.into_iter().flatten();
        pairs.filter_map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect()
    }

    /// The bytes of the snapshot from which the run goes on; `None` if there is none.
    pub(crate) fn snapshot(&mut self) -> Result<Option<Vec<u8>>, Failure> {
        if self.archive.by_name("snapshot.npy").is_err() {
            return Ok(None);
        }
        let mut read = || -> io::Result<Vec<u8>> {
            let (header, mut member) = self.header("snapshot")?;
            if header.shape().len() != 1 || header.dtype().num_bytes() != Some(1) {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "it is no list of bytes"));
            }
            let mut bytes = Vec::new();
            let length = header.shape()[0];
            member.by_ref().take(length.saturating_add(1)).read_to_end(&mut bytes)?;
            if bytes.len() as u64 == length {
                Ok(bytes)
            } else {
                Err(io::Error::new(io::ErrorKind::UnexpectedEof, "it is cut"))
            }
        };
        let bytes = read();
        bytes.map(Some).map_err(|error| self.fault("snapshot", &error))
    }

    /// Copies the rows of an array of numbers, all of them, `width` numbers each.
    pub(crate) fn copy(&mut self, array: &str, width: u64, to: &mut impl Write) -> Result<(), Failure> {
        let frames = self.frames()?;
        let copied = self.copy_rows(array, frames * width, to);
        copied.map_err(|error| self.fault(array, &error))
    }

    fn copy_rows(&mut self, array: &str, numbers: u64, to: &mut impl Write) -> io::Result<()> {
        let wrong = |what: String| io::Error::new(io::ErrorKind::InvalidData, what);
        let (header, mut member) = self.header(array)?;
        let own = header.shape().iter().try_fold(1u64, |product, &length| product.checked_mul(length));
        if own != Some(numbers) || header.order() != Order::C || header.dtype().num_bytes() != Some(8) {
            return Err(wrong(format!("it has the shape {:?}, and the run needs {numbers} numbers", header.shape())));
        }
        let copied = io::copy(&mut member.by_ref().take((8 * numbers).saturating_add(1)), to)?;
        if copied == 8 * numbers { Ok(()) } else { Err(wrong("it is cut".into())) }
    }

    fn header(&mut self, array: &str) -> io::Result<(NpyHeader, impl Read)> {
        let mut member = self.archive.by_name(&format!("{array}.npy"))?;
        Ok((NpyHeader::from_reader(&mut member)?, member))
    }

    fn fault(&self, array: &str, error: &io::Error) -> Failure {
        Failure::input(format!("cannot read `{}`: the array `{array}`: {error}", self.path.display()))
    }
}
