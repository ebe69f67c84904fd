//! Reads NPZ files by the description of the format, independently of the code that writes them.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// One array: its type as NumPy writes it, its shape, its bytes.
#[derive(Debug, PartialEq)]
pub(crate) struct Array {
    pub(crate) descr: String,
    pub(crate) shape: Vec<usize>,
    pub(crate) data: Vec<u8>,
}

impl Array {
    /// The numbers of the array; they must be little-endian float64.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        assert_eq!(self.descr, "<f8");
        let numbers: Vec<f64> = self.data.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect();
        assert_eq!(numbers.len(), self.shape.iter().product::<usize>());
        numbers
    }

    /// The texts of the array; they must be little-endian UTF-32 of one length, padded with zeros.
    pub(crate) fn texts(&self) -> Vec<String> {
        let width: usize = self.descr.strip_prefix("<U").unwrap().parse().unwrap();
        assert_eq!(self.data.len(), 4 * width * self.shape.iter().product::<usize>());
        let text = |bytes: &[u8]| {
            let codes = bytes.chunks(4).map(|b| u32::from_le_bytes(b.try_into().unwrap()));
            codes.take_while(|&code| code != 0).map(|code| char::from_u32(code).unwrap()).collect()
        };
        self.data.chunks(4 * width).map(text).collect()
    }
}

/// Every array of an NPZ file by its name.
pub(crate) fn read(path: &Path) -> BTreeMap<String, Array> {
    let mut archive = ZipArchive::new(File::open(path).unwrap()).unwrap();
    let mut arrays = BTreeMap::new();
    for index in 0..archive.len() {
        let mut member = archive.by_index(index).unwrap();
        let name = member.name().strip_suffix(".npy").unwrap().to_owned();
        let mut bytes = Vec::new();
        // Checks the member's checksum as well.
        member.read_to_end(&mut bytes).unwrap();
        arrays.insert(name, parse(&bytes));
    }
    arrays
}

/// Writes an NPZ file with one array changed, its header included.
pub(crate) fn rewrite(from: &Path, to: &Path, name: &str, change: &dyn Fn(&mut Vec<u8>)) {
    let mut archive = ZipArchive::new(File::open(from).unwrap()).unwrap();
    let mut written = ZipWriter::new(File::create(to).unwrap());
    for index in 0..archive.len() {
        let mut member = archive.by_index(index).unwrap();
        let mut bytes = Vec::new();
        member.read_to_end(&mut bytes).unwrap();
        if member.name().strip_suffix(".npy") == Some(name) {
            change(&mut bytes);
        }
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        written.start_file(member.name(), options).unwrap();
        written.write_all(&bytes).unwrap();
    }
    written.finish().unwrap();
}

fn parse(bytes: &[u8]) -> Array {
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!((10 + length) % 64, 0, "the numbers start aligned");
    let header = std::str::from_utf8(&bytes[10..10 + length]).unwrap();
    assert!(header.ends_with('\n') && header.contains("'fortran_order': False"), "{header}");
    let after = |key: &str| header.split_once(key).unwrap().1;
    let descr = after("'descr': '").split('\'').next().unwrap().to_owned();
    let tuple = after("'shape': (").split(')').next().unwrap();
    let shape: Vec<usize> =
        tuple.split(',').map(str::trim).filter(|n| !n.is_empty()).map(|n| n.parse().unwrap()).collect();
    assert_eq!(tuple.ends_with(','), shape.len() == 1, "a Python tuple of one, and no other, ends in a comma: {tuple}");
    Array { descr, shape, data: bytes[10 + length..].to_vec() }
}
