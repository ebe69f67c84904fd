//! The NPY format, version 1.0: a header with type and shape in the syntax of Python, then the numbers.
//! Source: NumPy, "NEP 1 — A simple file format for NumPy arrays" and numpy/lib/format.py.

/// The length of magic, version and the length of the header [bytes].
const PREAMBLE: usize = 10;
/// The data starts at a multiple of this [bytes], so that it can be mapped into memory.
const ALIGNMENT: usize = 64;

/// The header of an array in C order. `descr` is the type as NumPy writes it.
pub(crate) fn header(descr: &str, shape: &[usize]) -> Vec<u8> {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    // A Python tuple with one entry ends in a comma.
    let comma = if shape.len() == 1 { "," } else { "" };
    let shape = format!("({}{comma})", lengths.join(", "));
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    let unpadded = PREAMBLE + header.len() + 1;
    header.push_str(&" ".repeat(unpadded.next_multiple_of(ALIGNMENT) - unpadded));
    header.push('\n');
    // The header of an array of three dimensions has about 100 bytes, far below 65535.
    let length = u16::try_from(header.len()).unwrap_or(u16::MAX);
    [b"\x93NUMPY\x01\x00", length.to_le_bytes().as_slice(), header.as_bytes()].concat()
}

/// The type of little-endian float64.
pub(crate) const FLOAT64: &str = "<f8";
/// The type of a byte.
pub(crate) const BYTE: &str = "|u1";

/// A complete array of numbers of the shape (n,).
pub(crate) fn numbers(numbers: &[f64]) -> Vec<u8> {
    let mut bytes = header(FLOAT64, &[numbers.len()]);
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

/// A complete array of texts of the shape () or (n,). NumPy keeps texts as UTF-32 of one length, padded with zeros.
pub(crate) fn texts(shape: &[usize], texts: &[impl AsRef<str>]) -> Vec<u8> {
    let longest = texts.iter().map(|text| text.as_ref().chars().count()).max().unwrap_or(0);
    // Some versions of NumPy cannot read texts of length 0.
    let width = longest.max(1);
    let mut bytes = header(&format!("<U{width}"), shape);
    for text in texts {
        let characters = text.as_ref().chars().map(u32::from).chain(std::iter::repeat(0));
        bytes.extend(characters.take(width).flat_map(u32::to_le_bytes));
    }
    bytes
}
