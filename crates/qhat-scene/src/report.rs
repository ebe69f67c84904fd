//! The errors of one text: collects them, and shows the line of each with the mistake underlined.

use crate::error::{SceneError, SceneErrors};
use std::ops::Range;

/// The most errors of a report. A person corrects a few at a time, and a hostile text must not make a long list.
const MOST_ERRORS: usize = 20;
/// The most characters of a line that are shown; of a longer line, the part around the error.
const SHOWN: usize = 100;
/// The characters shown before the error in a line that is cut.
const BEFORE: usize = 40;
/// The most characters of a name or value that a message repeats.
const QUOTED: usize = 60;

/// The mistake of a message, without the value that was found: the same mistake with another value is the same error.
fn mistake(message: &str) -> &str {
    message.split(", but is ").next().unwrap_or(message)
}

/// The errors found so far in one text, and the text itself.
pub(crate) struct Report<'a> {
    name: &'a str,
    text: &'a str,
    line_starts: Vec<usize>,
    errors: Vec<SceneError>,
    more: bool,
}

impl<'a> Report<'a> {
    pub(crate) fn new(name: &'a str, text: &'a str) -> Self {
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Report { name, text, line_starts, errors: Vec::new(), more: false }
    }

    /// Adds an error about these bytes of the text, with the help. The same error at another place is told once, with
    /// all lines.
    pub(crate) fn error(&mut self, span: Range<usize>, message: impl Into<String>, help: Option<String>) {
        let message = message.into();
        let same = |former: &SceneError| mistake(&former.message) == mistake(&message) && former.help == help;
        if let Some(place) = self.errors.iter().position(same) {
            let line = self.line_of(self.on_characters(span).start);
            self.errors[place].also.push(line);
            return;
        }
        if self.errors.len() == MOST_ERRORS {
            self.more = true;
            return;
        }
        let span = self.on_characters(span);
        let line = self.line_of(span.start);
        let before = &self.text[self.line_starts[line - 1]..span.start];
        let error = SceneError {
            source_name: self.name.to_owned(),
            line,
            column: before.chars().count() + 1,
            message,
            excerpt: self.excerpt(line, &span),
            span,
            help,
            also: Vec::new(),
        };
        self.errors.push(error);
    }

    /// Whether the report takes no more errors, so that checking on is of no use.
    pub(crate) fn is_full(&mut self) -> bool {
        // Not `self.more |= is_full`: rustc 1.95.0 at opt-level 2 and 3 compiles that, in callers that go on to
        // `error`, to `self.more = true`.
        if self.errors.len() < MOST_ERRORS {
            return false;
        }
        self.more = true;
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// The errors in the order of the text.
    pub(crate) fn into_errors(mut self) -> SceneErrors {
        self.errors.sort_by_key(|error| error.span.start);
        SceneErrors { errors: self.errors, more: self.more }
    }

    /// The line of a byte, from 1.
    pub(crate) fn line_of(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset).max(1)
    }

    /// A name from the scene in backticks, cut where it is long, safe for a terminal.
    pub(crate) fn quoted(&self, name: &str) -> String {
        format!("`{}`", shortened(name))
    }

    /// The text of a value as it stands in the scene, cut where it is long, safe for a terminal.
    pub(crate) fn written(&self, span: &Range<usize>) -> String {
        shortened(self.text.get(span.clone()).unwrap_or_default())
    }

    /// The place of a piece of a text value that stands at `span`; the place of the whole value where it is written
    /// with escapes.
    pub(crate) fn piece(&self, span: &Range<usize>, value: &str, piece: &Range<usize>) -> Range<usize> {
        match self.text.get(span.clone()).and_then(|written| written.find(value)) {
            Some(quote) if !value.is_empty() => span.start + quote + piece.start..span.start + quote + piece.end,
            _ => span.clone(),
        }
    }

    /// A sentence that quotes the scene, safe for a terminal.
    pub(crate) fn fitted(&self, sentence: &str) -> String {
        sentence.chars().map(fit).collect()
    }

    fn on_characters(&self, span: Range<usize>) -> Range<usize> {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let mut end = span.end.clamp(start, self.text.len());
        while !self.text.is_char_boundary(end) {
            end += 1;
        }
        start..end
    }

    fn excerpt(&self, line: usize, span: &Range<usize>) -> String {
        let start = self.line_starts[line - 1];
        let end = self.line_starts.get(line).map_or(self.text.len(), |next| next - 1);
        let text = self.text[start..end].trim_end_matches('\r');
        let column = self.text[start..span.start].chars().count();
        let marked = self.text[span.start..span.end.min(end).max(span.start)].chars().count();

        let first = if text.chars().nth(SHOWN).is_some() { column.saturating_sub(BEFORE) } else { 0 };
        let mut shown: String = text.chars().skip(first).take(SHOWN).map(fit).collect();
        let mut indent = column - first;
        if first > 0 {
            shown.insert(0, '…');
            indent += 1;
        }
        if text.chars().nth(first + SHOWN).is_some() {
            shown.push('…');
        }
        let carets = marked.min((first + SHOWN).saturating_sub(column)).max(1);
        let gutter = " ".repeat(line.to_string().len());
        let underline = format!("{}{}", " ".repeat(indent), "^".repeat(carets));
        format!("{gutter} |\n{line} | {}\n{gutter} | {underline}", shown.trim_end())
    }
}

fn shortened(text: &str) -> String {
    let mut shown: String = text.chars().take(QUOTED).map(fit).collect();
    if text.chars().nth(QUOTED).is_some() {
        shown.push('…');
    }
    shown
}

/// Text that is safe on a terminal, for names that come from scenes: control characters, and characters that turn the
/// direction of writing, become U+FFFD or a space. Line ends stay.
pub fn fitted(text: &str) -> String {
    text.chars().map(|character| if character == '\n' { character } else { fit(character) }).collect()
}

/// The character, or a replacement for one that is unsafe on a terminal: control characters, and characters that turn
/// the direction of writing, could make a message read as another.
fn fit(character: char) -> char {
    match character {
        '\t' => ' ',
        '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}' => '\u{FFFD}',
        character if character.is_control() => '\u{FFFD}',
        character => character,
    }
}
