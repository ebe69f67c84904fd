//! The files of the page, embedded when the command was compiled.

use rust_embed::RustEmbed;
use std::borrow::Cow;

#[derive(RustEmbed)]
#[folder = "../../playground/dist"]
struct Page;

/// A file of the page and its MIME type.
pub(crate) fn file(path: &str) -> Option<(Cow<'static, [u8]>, &'static str)> {
    let path = if path == "/" { "index.html" } else { path.strip_prefix('/')? };
    Page::get(path).map(|file| (file.data, mime_type(path)))
}

/// The MIME type of a file by its ending. Browsers compile WebAssembly only with its own type.
fn mime_type(path: &str) -> &'static str {
    match path.rsplit_once('.').map(|(_, ending)| ending) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("wasm") => "application/wasm",
        Some("json" | "map") => "application/json",
        Some("webmanifest") => "application/manifest+json",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("ico") => "image/x-icon",
        Some("woff2") => "font/woff2",
        Some("toml" | "txt") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}
