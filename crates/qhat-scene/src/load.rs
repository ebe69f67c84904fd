//! From text to scene, stage by stage.

use crate::build::build;
use crate::check::check;
use crate::error::SceneErrors;
use crate::model::Document;
use crate::parameters::{self, Parameters};
use crate::report::Report;
use crate::scene::{Scene, Source};
use crate::schema::schema;
use crate::tree::{json, toml};

/// The most bytes of a scene that are read. A hand-written scene has kilobytes; a scene that lists every particle of a
/// large net has a few megabytes.
const MOST_BYTES: usize = 16 << 20;

/// The format of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// TOML 1.0, for people.
    Toml,
    /// JSON, for programs.
    Json,
}

impl Format {
    /// The format of a file by its name: JSON where the name ends in `.json`, in any case; TOML otherwise.
    pub fn from_path(name: &str) -> Format {
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        if extension.eq_ignore_ascii_case("json") { Format::Json } else { Format::Toml }
    }
}

/// Reads a scene. Errors call the text `source_name`.
///
/// # Errors
/// All mistakes that can be found in one pass.
pub fn load(text: &str, source_name: &str, format: Format) -> Result<Scene, SceneErrors> {
    load_with(text, source_name, format, &[])
}

/// Reads a scene with other values of some of its parameters.
///
/// # Errors
/// As [`load`]; a name that no parameter has, a value that is not finite or out of the range of its parameter.
pub fn load_with(
    text: &str,
    source_name: &str,
    format: Format,
    parameters: &[(String, f64)],
) -> Result<Scene, SceneErrors> {
    let mut report = Report::new(source_name, text);
    let scene = read(text, format, parameters, &mut report);
    match scene {
        Some(mut scene) if report.is_empty() => {
            if !scene.system.parameters().is_empty() {
                scene.source = Some(Source::new(text, source_name, format));
            }
            Ok(*scene)
        }
        _ => Err(report.into_errors()),
    }
}

/// Reads a scene from the bytes of a file, in UTF-8, or in UTF-16 with its byte order mark, as Windows PowerShell 5
/// writes it.
///
/// # Errors
/// The errors of [`load`], and bytes that are neither.
pub fn load_bytes(bytes: &[u8], source_name: &str, format: Format) -> Result<Scene, SceneErrors> {
    load_bytes_with(bytes, source_name, format, &[])
}

/// The same with other values of some of its parameters.
///
/// # Errors
/// The errors of [`load_with`], and bytes that are neither.
pub fn load_bytes_with(
    bytes: &[u8],
    source_name: &str,
    format: Format,
    parameters: &[(String, f64)],
) -> Result<Scene, SceneErrors> {
    if let Some(text) = from_utf16(bytes) {
        return load_with(&text, source_name, format, parameters);
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => load_with(text, source_name, format, parameters),
        Err(error) => {
            // The report gets the text before the first such byte, because the rest has no certain reading.
            let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            let mut report = Report::new(source_name, &valid);
            let message = format!("byte {} of the file is not UTF-8 text", error.valid_up_to());
            report.error(valid.len()..valid.len(), message, Some("save the file as UTF-8".into()));
            Err(report.into_errors())
        }
    }
}

/// The text of a file in UTF-16 that begins with its byte order mark; `None` for any other file. A code unit without
/// its pair becomes U+FFFD.
pub fn from_utf16(bytes: &[u8]) -> Option<String> {
    let (mark, rest) = bytes.split_first_chunk::<2>()?;
    let unit: fn([u8; 2]) -> u16 = match mark {
        [0xFF, 0xFE] => u16::from_le_bytes,
        [0xFE, 0xFF] => u16::from_be_bytes,
        _ => return None,
    };
    let units = rest.chunks(2).map(|pair| unit([pair[0], pair.get(1).copied().unwrap_or(0)]));
    Some(char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)).collect())
}

fn read(text: &str, format: Format, set: &[(String, f64)], report: &mut Report<'_>) -> Option<Box<Scene>> {
    if text.len() > MOST_BYTES {
        let message = format!("the scene has {} bytes; at most {MOST_BYTES} are read", text.len());
        report.error(0..0, message, Some("a `[[generate]]` block makes many particles from few lines".into()));
        return None;
    }
    // Some editors begin a file with a byte order mark. Blanks of the same length keep all places in the text.
    let unmarked = text.strip_prefix('\u{FEFF}').map(|rest| format!("   {rest}"));
    let content = unmarked.as_deref().unwrap_or(text);
    if content.trim().is_empty() {
        report.error(0..0, "the scene is empty", Some("begin with `schema`, `name` and `dimension`".into()));
        return None;
    }
    // Neither TOML nor JSON begins with a `<`.
    if content.trim_start().starts_with('<') {
        let start = content.len() - content.trim_start().len();
        let help = "a scene is TOML or JSON: write its particles, constraints and loads anew".to_owned();
        report.error(start..start + 1, "this is XML (MJCF, URDF?), and no scene", Some(help));
        return None;
    }
    let mut tree = match format {
        Format::Toml => toml::parse(content, report),
        Format::Json => json::parse(content, report),
    }?;
    parameters::set(&mut tree, set, report);
    let checked = check(&tree, schema(), &Parameters::of(&tree), report)?;
    if checked.has_gaps {
        return None;
    }
    match serde_json::from_value::<Document>(checked.value) {
        Ok(document) => build(document, &tree, checked.uses, report).map(Box::new),
        Err(error) => {
            // The schema is made from the same types, so that this is not reached; if it were, it must not be silent.
            report.error(0..0, format!("the scene cannot be read: {error}"), None);
            None
        }
    }
}
