//! A still as PNG, from its SVG.

use crate::picture::{Options, Picture, svg};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use std::sync::Arc;

/// Inter Regular, with the letters that qhat's own texts and most names in scenes need; made by scripts/embed-font.
const FONT: &[u8] = include_bytes!("../font/Inter-Regular.ttf");

/// The error of a PNG that cannot be made.
#[derive(Debug)]
pub enum PngError {
    /// A width or height of 0, or above [`Options::MOST`].
    Size([u32; 2]),
    /// The picture could not be read or written; the text is the message of the library.
    Library(String),
}

impl std::fmt::Display for PngError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            PngError::Size([width, height]) => {
                let most = Options::MOST;
                write!(f, "a picture has 1 to {most} pixels in width and in height, not {width} × {height}")
            }
            PngError::Library(words) => write!(f, "the picture could not be made: {words}"),
        }
    }
}

impl std::error::Error for PngError {}

/// A still as the bytes of a PNG file: the same bytes for the same picture and options, on every run.
///
/// All text is in the embedded font, Inter; fonts of the machine are not used. The font has the letters of Latin, Greek
/// and Cyrillic. Other letters leave a gap.
///
/// # Errors
/// A width or height of 0, or above [`Options::MOST`].
pub fn png(picture: &Picture<'_>, options: &Options) -> Result<Vec<u8>, PngError> {
    let [width, height] = options.size;
    if ![width, height].iter().all(|side| (1..=Options::MOST).contains(side)) {
        return Err(PngError::Size(options.size));
    }
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family("Inter");
    let reading = usvg::Options { fontdb: Arc::new(fonts), font_family: "Inter".into(), ..usvg::Options::default() };
    let library = |error: &dyn std::fmt::Display| PngError::Library(error.to_string());
    let tree = usvg::Tree::from_str(&svg(picture, options), &reading).map_err(|error| library(&error))?;
    let mut pixels = Pixmap::new(width, height).ok_or(PngError::Size(options.size))?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| library(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Reading;
    use std::collections::HashSet;

    /// The pixels of a still of a shipped scene.
    fn pixels(scene: &str, options: &Options) -> (png::OutputInfo, Vec<[u8; 4]>, Vec<u8>) {
        let shipped = qhat_scene::shipped().iter().find(|shipped| shipped.name == scene).unwrap();
        let mut simulation = shipped.load().unwrap().simulation().unwrap();
        let reading = Reading::of(&mut simulation);
        let bytes = super::png(&Picture::new(&simulation, &reading, "Still"), options).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes.as_slice())).read_info().unwrap();
        let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut buffer).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
        let colours = buffer.chunks(4).map(|pixel| pixel.try_into().unwrap()).collect();
        (info, colours, bytes)
    }

    #[test]
    fn a_still_has_its_size_its_colours_and_the_same_bytes_every_time() {
        for dark in [false, true] {
            let options = Options { size: [600, 400], dark };
            let (info, colours, bytes) = pixels("bridge-truss", &options);
            assert_eq!((info.width, info.height), (600, 400));
            let background = if dark { [0x12, 0x16, 0x1b, 255] } else { [0xf6, 0xf5, 0xf1, 255] };
            assert_eq!(colours[0], background);
            assert!(colours.iter().collect::<HashSet<_>>().len() > 100);
            // The legend has both ends of the scale of colours.
            let ends = if dark { [[255, 158, 66], [96, 172, 255]] } else { [[201, 88, 10], [22, 92, 204]] };
            for [r, g, b] in ends {
                assert!(colours.contains(&[r, g, b, 255]), "{r} {g} {b}");
            }
            assert!(pixels("bridge-truss", &options).2 == bytes);
        }
    }

    #[test]
    fn text_is_drawn_from_the_embedded_font() {
        let shipped = qhat_scene::shipped()[0].load().unwrap();
        let of = |name: &str| {
            let tension = vec![0.0; shipped.system.links().count()];
            let (system, state) = (&shipped.system, &shipped.state);
            let picture = Picture { system, state, time: 0.0, tension: &tension, broken: &[], name, note: "" };
            super::png(&picture, &Options::default()).unwrap()
        };
        // All letters look different from each other, and from none.
        let pictures: HashSet<Vec<u8>> = ["", "A", "é", "λ", "Ж", "²", "−"].map(of).into();
        assert_eq!(pictures.len(), 7);
        assert_eq!(of("長"), of(""), "a letter that the font lacks leaves a gap");
    }

    #[test]
    fn a_size_without_room_is_refused() {
        let shipped = qhat_scene::shipped()[0].load().unwrap();
        let (system, state) = (&shipped.system, &shipped.state);
        let picture = Picture { system, state, time: 0.0, tension: &[], broken: &[], name: "", note: "" };
        for size in [[0, 100], [100, 0], [100, Options::MOST + 1], [u32::MAX; 2]] {
            let error = super::png(&picture, &Options { size, dark: false }).unwrap_err();
            assert!(matches!(error, PngError::Size(refused) if refused == size), "{error}");
        }
    }
}
