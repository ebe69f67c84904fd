//! The source of a scene: a file, a scene that comes with qhat, or stdin.

use crate::failure::Failure;
use qhat_scene::{Format, Scene, SceneErrors, Shipped, from_utf16, shipped};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The most bytes that are read, so that a stream without an end ends. The reader of scenes has a smaller limit.
const LARGEST: u64 = 64 << 20;

/// The bytes of a scene and its name.
#[derive(Debug)]
pub(crate) struct Source {
    /// The name in messages: the path of a file, `pendulum.toml` for a scene that comes with qhat, or `stdin`.
    pub(crate) name: String,
    bytes: Vec<u8>,
    format: Format,
    /// The path of a file; none for the other sources.
    path: Option<PathBuf>,
}

/// The text of a scene, kept with the results.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Text {
    name: String,
    bytes: Vec<u8>,
    is_json: bool,
}

impl Source {
    /// Reads the source that an argument names: stdin for `-`, else a file, else a scene that comes with qhat.
    pub(crate) fn read(argument: &str) -> Result<Self, Failure> {
        if argument == "-" {
            let bytes = bytes(io::stdin().lock(), "stdin")?;
            // A JSON scene is an object; no TOML begins with a brace.
            let json = match from_utf16(&bytes) {
                Some(text) => text.trim_start().starts_with('{'),
                None => bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes).trim_ascii_start().starts_with(b"{"),
            };
            let format = if json { Format::Json } else { Format::Toml };
            return Ok(Source { name: "stdin".into(), bytes, format, path: None });
        }
        match File::open(argument) {
            Ok(file) if file.metadata().is_ok_and(|metadata| metadata.is_dir()) => {
                // A folder called `net` must not hide the scene of that name.
                let folder = format!("`{argument}` is a folder, not a scene file");
                Source::shipped(argument).map_err(|_| Failure::input(folder))
            }
            Ok(file) => Ok(Source {
                name: argument.into(),
                bytes: bytes(file, argument)?,
                format: Format::from_path(argument),
                path: Some(argument.into()),
            }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Source::shipped(argument),
            Err(error) => Err(Failure::io(format!("cannot read `{argument}`"), &error)),
        }
    }

    fn shipped(argument: &str) -> Result<Self, Failure> {
        let Some(scene) = find_shipped(argument) else {
            let message = format!("there is no file `{argument}`, and no scene of that name comes with qhat");
            return Err(Failure::input(format!("{message}\n{}", available())));
        };
        let name = format!("{}.toml", scene.name);
        Ok(Source { name, bytes: scene.text.into(), format: Format::Toml, path: None })
    }

    /// The current bytes: a file is read again, because it may have been edited.
    #[cfg(feature = "page")]
    pub(crate) fn current_bytes(&self) -> Vec<u8> {
        let again = self.path.as_ref().and_then(|path| File::open(path).ok());
        again.and_then(|file| bytes(file, &self.name).ok()).unwrap_or_else(|| self.bytes.clone())
    }

    /// The text, to be kept.
    pub(crate) fn text(&self) -> Text {
        Text { name: self.file_name(), bytes: self.bytes.clone(), is_json: self.format == Format::Json }
    }

    /// The source of a text that was kept.
    pub(crate) fn restored(Text { name, bytes, is_json }: Text) -> Self {
        Source { name, bytes, format: if is_json { Format::Json } else { Format::Toml }, path: None }
    }

    /// The name without its folders.
    pub(crate) fn file_name(&self) -> String {
        let path = self.path.as_deref().unwrap_or(Path::new(&self.name));
        path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
    }

    /// The scene with these values of its parameters, or its errors.
    pub(crate) fn load(&self, parameters: &[(String, f64)]) -> Result<Scene, SceneErrors> {
        qhat_scene::load_bytes_with(&self.bytes, &self.name, self.format, parameters)
    }

    /// A hash of the text, by which results can be matched with it.
    pub(crate) fn hash(&self) -> String {
        let digest = Sha256::digest(&self.bytes);
        let hex: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        format!("sha256:{hex}")
    }
}

/// The scene of a name that comes with qhat.
pub(crate) fn find_shipped(name: &str) -> Option<&'static Shipped> {
    shipped().iter().find(|scene| scene.name == name)
}

/// A line with the names of the scenes that come with qhat.
pub(crate) fn available() -> String {
    let names: Vec<&str> = shipped().iter().map(|scene| scene.name).collect();
    format!("scenes that come with qhat: {}", names.join(", "))
}

fn bytes(from: impl Read, name: &str) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let read = from.take(LARGEST + 1).read_to_end(&mut bytes);
    read.map_err(|error| Failure::io(format!("cannot read `{name}`"), &error))?;
    if bytes.len() as u64 > LARGEST {
        return Err(Failure::input(format!("`{name}` is larger than {} MiB, more than any scene", LARGEST >> 20)));
    }
    Ok(bytes)
}
