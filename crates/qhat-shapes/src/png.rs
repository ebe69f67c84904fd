//! A still as PNG, from its SVG.

use crate::picture::{Options, Picture, svg};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use std::sync::Arc;

/// Inter Regular, of the letters that qhat's own texts and most names of scenes need; made by scripts/embed-font.
const FONT: &[u8] = include_bytes!("../font/Inter-Regular.ttf");

/// Why there is no PNG.
#[derive(Debug)]
pub enum PngError {
    /// A width or height of 0, or more pixels than memory has room for.
    Size([u32; 2]),
    /// The picture could not be read or written, in the words of the library.
    Library(String),
}

impl std::fmt::Display for PngError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            PngError::Size([width, height]) => write!(f, "there is no room for a picture of {width} × {height} pixels"),
            PngError::Library(words) => write!(f, "the picture could not be made: {words}"),
        }
    }
}

impl std::error::Error for PngError {}

/// A still as the bytes of a PNG file: the same bytes for the same picture and options, on every run.
///
/// All text is in the embedded font, Inter: no font of the machine is looked for. Letters that the font lacks (it has
/// those of Latin, Greek and Cyrillic) are drawn as empty boxes.
///
/// # Errors
/// A size without pixels or with too many of them.
pub fn png(picture: &Picture<'_>, options: &Options) -> Result<Vec<u8>, PngError> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("Inter");
    let reading = usvg::Options { fontdb: Arc::new(fonts), font_family: "Inter".into(), ..usvg::Options::default() };
    let library = |error: &dyn std::fmt::Display| PngError::Library(error.to_string());
    let tree = usvg::Tree::from_str(&svg(picture, options), &reading).map_err(|error| library(&error))?;
    let [width, height] = options.size;
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Size(options.size))?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| library(&error))
}
