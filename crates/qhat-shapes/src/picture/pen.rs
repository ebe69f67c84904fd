//! The writer of a still: elements of SVG, with every name and text escaped.

use super::path::{Path, number};
use quick_xml::Writer;
use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};

/// The fonts of all text, in order of preference. PNGs use an embedded Inter; a reader of SVG may have it or not.
const FONTS: &str = "Inter, system-ui, sans-serif";

/// The colours and widths with which a path is painted; a width of 0 draws no border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke<'a> {
    pub(super) colour: &'a str,
    /// The width of the border \[px\].
    pub(super) width: f64,
    /// Lengths of dash and gap \[px\].
    pub(super) dash: Option<[f64; 2]>,
    /// The opacity of the inside, from 0 to 1.
    pub(super) fill: f64,
}

/// An attribute and its value.
pub(super) type Attribute<'a> = (&'a str, &'a str);

/// The width of the background around letters \[px\]: a line behind a word would strike it through.
const HALO: &str = "6";

/// A document being written.
pub(super) struct Pen {
    writer: Writer<Vec<u8>>,
    background: &'static str,
}

impl Pen {
    pub(super) fn new(background: &'static str) -> Self {
        Pen { writer: Writer::new(Vec::new()), background }
    }

    /// Begins a document of a size \[px\] that is laid out in units of its own.
    pub(super) fn open_document(&mut self, title: &str, size: [u32; 2], layout: [f64; 2]) {
        let [width, height] = size.map(|length| length.to_string());
        let view_box = format!("0 0 {} {}", number(layout[0]), number(layout[1]));
        self.open(
            "svg",
            &[
                ("xmlns", "http://www.w3.org/2000/svg"),
                ("width", &width),
                ("height", &height),
                ("viewBox", &view_box),
                ("font-family", FONTS),
            ],
        );
        self.title(title);
    }

    pub(super) fn finish(mut self) -> String {
        self.close("svg");
        // Every byte came from text.
        String::from_utf8(self.writer.into_inner()).unwrap_or_default()
    }

    pub(super) fn open(&mut self, name: &str, attributes: &[Attribute<'_>]) {
        self.write(Event::Start(start(name, attributes)));
    }

    pub(super) fn close(&mut self, name: &str) {
        self.write(Event::End(BytesEnd::new(name)));
    }

    pub(super) fn element(&mut self, name: &str, attributes: &[Attribute<'_>]) {
        self.write(Event::Empty(start(name, attributes)));
    }

    /// An element with a title, which a browser shows under the pointer.
    pub(super) fn titled(&mut self, name: &str, attributes: &[Attribute<'_>], title: &str) {
        self.open(name, attributes);
        self.title(title);
        self.close(name);
    }

    /// A path of a class; an empty path is left out.
    pub(super) fn path(&mut self, class: &str, path: &Path, stroke: Stroke<'_>) {
        if path.is_empty() {
            return;
        }
        let [width, opacity] = [stroke.width, stroke.fill].map(number);
        let dash = stroke.dash.map(|lengths| lengths.map(number).join(" "));
        let mut attributes = vec![("class", class), ("d", path.letters())];
        match stroke.fill > 0.0 {
            true => attributes.extend([("fill", stroke.colour), ("fill-opacity", &opacity)]),
            false => attributes.push(("fill", "none")),
        }
        if stroke.width > 0.0 {
            let ends = [("stroke-linecap", "round"), ("stroke-linejoin", "round")];
            attributes.extend([("stroke", stroke.colour), ("stroke-width", width.as_str())]);
            attributes.extend(ends);
        }
        attributes.extend(dash.as_deref().map(|dash| ("stroke-dasharray", dash)));
        self.element("path", &attributes);
    }

    /// Text whose baseline begins, has its middle or ends (`anchor`) at a spot \[px\].
    pub(super) fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, colour: &str, anchor: &str) {
        let [x, y, size] = [x, y, size].map(number);
        let place = [("x", x.as_str()), ("y", &y), ("font-size", &size), ("fill", colour), ("text-anchor", anchor)];
        let halo = [("stroke", self.background), ("stroke-width", HALO), ("stroke-linejoin", "round")];
        let mut attributes = [&place[..], &halo].concat();
        attributes.push(("paint-order", "stroke"));
        self.open("text", &attributes);
        self.write(Event::Text(BytesText::new(&fitted(text))));
        self.close("text");
    }

    fn title(&mut self, title: &str) {
        self.open("title", &[]);
        self.write(Event::Text(BytesText::new(&fitted(title))));
        self.close("title");
    }

    fn write(&mut self, event: Event<'_>) {
        // Writing into memory cannot fail.
        let _ = self.writer.write_event(event);
    }
}

fn start<'a>(name: &'a str, attributes: &[Attribute<'_>]) -> BytesStart<'a> {
    let mut start = BytesStart::new(name);
    for &(name, value) in attributes {
        start.push_attribute((name, value));
    }
    start
}

/// Text without the characters that XML forbids and without the characters that change the direction of writing: names
/// come from scenes of users.
fn fitted(text: &str) -> String {
    let fit = |character: char| match character {
        '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => '\u{FFFD}',
        '\u{FFFE}' | '\u{FFFF}' => '\u{FFFD}',
        character if character.is_control() => '\u{FFFD}',
        character => character,
    };
    text.chars().map(fit).collect()
}
