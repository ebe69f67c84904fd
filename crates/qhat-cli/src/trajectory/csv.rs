//! CSV: a header, then one line a frame. The format has no place for the origin, which goes into FILE.csv.json, nor for
//! the events, which go into FILE.csv.events.csv.

use super::Kept;
use super::events::speed;
use super::quantity::{Frame, Quantity, Subjects};
use super::target::Target;
use crate::failure::Failure;
use qhat::Event;
use std::fmt::Write as _;
use std::io::{self, Read, Seek, SeekFrom, Write as _};
use tempfile::NamedTempFile;

/// Bytes of whole lines that are gathered before they are written.
const GATHERED: usize = 1 << 16;

/// A trajectory being written as CSV.
pub(crate) struct Recorder {
    target: Target,
    quantities: Vec<Quantity>,
    file: NamedTempFile,
    /// The bytes of whole lines in the file.
    written: u64,
    /// Lines that are not in the file yet.
    lines: csv::Writer<Vec<u8>>,
    number: String,
}

impl Recorder {
    pub(super) fn new(target: Target, subjects: Subjects<'_>, quantities: Vec<Quantity>) -> Result<Self, Failure> {
        let (file, lines) = (target.temporary()?, csv::Writer::from_writer(Vec::new()));
        let columns: Vec<String> = quantities.iter().flat_map(|quantity| quantity.columns(subjects)).collect();
        let mut recorder = Recorder { target, quantities, file, written: 0, lines, number: String::new() };
        recorder.lines.write_record(columns).map_err(|error| recorder.failed(&io::Error::other(error)))?;
        Ok(recorder)
    }

    pub(super) fn frame(&mut self, frame: &Frame) -> Result<(), Failure> {
        let rows: Vec<_> = self.quantities.iter().map(|quantity| quantity.row(frame)).collect();
        let numbers = rows.iter().flat_map(|row| row.iter());
        self.add(numbers).map_err(|error| self.failed(&io::Error::other(error)))?;
        let outcome = if self.lines.get_ref().len() >= GATHERED { self.write() } else { Ok(()) };
        outcome.map_err(|error| self.failed(&error))
    }

    /// Puts the origin, the events and the lines in place. On a full disk the last half of the lines is given up, again
    /// and again, until the others fit beside the rest.
    pub(super) fn finish(mut self, whole: &str, part: &str, events: &[Event]) -> Result<Kept, Failure> {
        let mut kept = if self.write().is_ok() { Kept::Whole } else { Kept::Part };
        loop {
            // Origin and events come first, so that no CSV is ever without them.
            let (origin, last) = match kept {
                Kept::Whole => (whole, f64::INFINITY),
                _ => (part, self.last_time().unwrap_or(f64::INFINITY)),
            };
            let events = &events[..events.partition_point(|event| event.time <= last)];
            let table = (!events.is_empty()).then(|| event_table(events)).transpose();
            let table = table.map_err(|error| self.failed(&io::Error::other(error)))?;
            match self.target.put_origin(origin).and_then(|()| self.target.put_events(table.as_deref())) {
                Ok(()) => return self.target.put(self.file).map(|()| kept),
                Err(failure) => {
                    let is_cut = self.give_up_half();
                    if !is_cut.is_ok_and(|is_cut| is_cut) {
                        return Err(failure);
                    }
                    kept = Kept::Part;
                }
            }
        }
    }

    /// Brings the gathered lines to the file; where the disk is full, the file ends with the lines before them.
    fn write(&mut self) -> io::Result<()> {
        self.lines.flush()?;
        let bytes =
            std::mem::replace(&mut self.lines, csv::Writer::from_writer(Vec::new())).into_inner().unwrap_or_default();
        let file = self.file.as_file_mut();
        match file.write_all(&bytes) {
            Ok(()) => self.written += bytes.len() as u64,
            Err(error) => {
                // The lines that are whole on the disk stay.
                let reached = file.stream_position()?.saturating_sub(self.written) as usize;
                let whole = bytes[..reached.min(bytes.len())].iter().rposition(|&byte| byte == b'\n');
                self.written += whole.map_or(0, |end| end as u64 + 1);
                self.cut()?;
                return Err(error);
            }
        }
        Ok(())
    }

    /// Shortens the file to about half of its lines. Returns whether there were any behind the header.
    fn give_up_half(&mut self) -> io::Result<bool> {
        let mut text = Vec::new();
        self.file.as_file_mut().rewind()?;
        self.file.as_file_mut().read_to_end(&mut text)?;
        let end = text[..text.len() / 2].iter().rposition(|&byte| byte == b'\n');
        match end {
            Some(end) => {
                self.written = end as u64 + 1;
                self.cut().map(|()| true)
            }
            None => Ok(false),
        }
    }

    /// t of the last line \[s\], which is its first number; `None` if there is no line behind the header.
    fn last_time(&mut self) -> Option<f64> {
        let mut text = String::new();
        let file = self.file.as_file_mut();
        file.rewind().and_then(|()| file.read_to_string(&mut text)).ok()?;
        text.lines().last()?.split(',').next()?.parse().ok()
    }

    fn cut(&mut self) -> io::Result<()> {
        let file = self.file.as_file_mut();
        file.set_len(self.written)?;
        file.seek(SeekFrom::Start(self.written)).map(|_| ())
    }

    fn add<'a>(&mut self, numbers: impl Iterator<Item = &'a f64>) -> csv::Result<()> {
        for number in numbers {
            self.number.clear();
            // The shortest decimal that reads back as the same bits, with an exponent where that is shorter.
            let _ = write!(self.number, "{number:?}");
            self.lines.write_field(&self.number)?;
        }
        self.lines.write_record(None::<&[u8]>)
    }

    fn failed(&self, error: &io::Error) -> Failure {
        self.target.cannot_write(error)
    }
}

/// The events as a CSV: a header, then one line an event.
fn event_table(events: &[Event]) -> csv::Result<Vec<u8>> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["t", "constraint", "kind", "speed", "impulse"])?;
    for event in events {
        let [t, speed, impulse] = [event.time, speed(event), event.impulse].map(|number| format!("{number:?}"));
        table.write_record([&t, &event.constraint, event.kind.name(), &speed, &impulse])?;
    }
    table.into_inner().map_err(|error| error.into_error().into())
}
