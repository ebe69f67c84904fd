//! Reads one frame of a trajectory back from NPZ.

use crate::failure::Failure;
use npyz::{NpyFile, NpyHeader, Order};
use std::fs::File;
use std::io::{self, BufReader, Read};
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

    fn header(&mut self, array: &str) -> io::Result<(NpyHeader, impl Read)> {
        let mut member = self.archive.by_name(&format!("{array}.npy"))?;
        Ok((NpyHeader::from_reader(&mut member)?, member))
    }

    fn fault(&self, array: &str, error: &io::Error) -> Failure {
        Failure::input(format!("cannot draw from `{}`: the array `{array}`: {error}", self.path.display()))
    }
}
