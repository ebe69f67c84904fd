//! The answer to one request, as bytes; this file uses no socket.

use super::page;
use crate::source::Source;
use std::borrow::Cow;

/// The page may run its own scripts and WebAssembly and talk to its own server. No other page may show it in a frame.
const CONTENT_SECURITY_POLICY: &str = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; object-src 'none'; \
                                       base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The headers of every answer.
const HEADERS: [(&str, &str); 7] = [
    ("Content-Security-Policy", CONTENT_SECURITY_POLICY),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "DENY"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Opener-Policy", "same-origin"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    // The next qhat at this address may serve another page or scene.
    ("Cache-Control", "no-cache"),
];

/// An HTTP answer.
pub(crate) struct Answer {
    status: &'static str,
    headers: Vec<(&'static str, String)>,
    body: Cow<'static, [u8]>,
}

impl Answer {
    fn new(status: &'static str, mime_type: &str, body: impl Into<Cow<'static, [u8]>>) -> Self {
        Answer { status, headers: vec![("Content-Type", mime_type.to_owned())], body: body.into() }
    }

    /// An answer that refuses a request, with the reason as a line of text.
    pub(crate) fn refusal(status: &'static str, why: &'static str) -> Self {
        Answer::new(status, "text/plain; charset=utf-8", format!("{why}\n").into_bytes())
    }

    /// The bytes to send, without the body for a HEAD request.
    pub(crate) fn bytes(&self, head_only: bool) -> Vec<u8> {
        let mut head = format!("HTTP/1.1 {}\r\nConnection: close\r\n", self.status);
        let own = self.headers.iter().map(|(name, value)| (*name, value.as_str()));
        for (name, value) in own.chain(HEADERS) {
            head += &format!("{name}: {value}\r\n");
        }
        // HTTP forbids a length in an answer of status 204.
        if !self.status.starts_with("204") {
            head += &format!("Content-Length: {}\r\n", self.body.len());
        }
        head += "\r\n";
        let body: &[u8] = if head_only { &[] } else { &self.body };
        [head.as_bytes(), body].concat()
    }
}

/// The answer to a request for a path without its query. `host` is the header of the request, `port` that of the
/// server.
pub(crate) fn answer(method: &str, path: &str, host: Option<&str>, port: u16, scene: Option<&Source>) -> Answer {
    // A foreign name that resolves to 127.0.0.1 (DNS rebinding) would let a foreign page read the answers.
    let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    if !host.is_some_and(|host| own.iter().any(|own| own.eq_ignore_ascii_case(host))) {
        return Answer::refusal("403 Forbidden", "qhat answers only to 127.0.0.1 and localhost");
    }
    if !matches!(method, "GET" | "HEAD") {
        let mut answer = Answer::refusal("405 Method Not Allowed", "qhat answers GET and HEAD only");
        answer.headers.push(("Allow", "GET, HEAD".into()));
        return answer;
    }
    if path == "/scene" {
        return scene.map_or_else(no_scene, scene_text);
    }
    match page::file(path) {
        Some((body, mime_type)) => Answer::new("200 OK", mime_type, body),
        None => Answer::refusal("404 Not Found", "there is no such file"),
    }
}

fn scene_text(scene: &Source) -> Answer {
    let mut answer = Answer::new("200 OK", "text/plain; charset=utf-8", scene.current_bytes());
    answer.headers.push(("X-Qhat-Scene-Name", percent_encoded(&scene.file_name())));
    answer
}

/// The answer where the command was given no scene: status 204, which browsers do not log as an error.
fn no_scene() -> Answer {
    Answer { status: "204 No Content", headers: Vec::new(), body: Cow::Borrowed(&[]) }
}

/// A text in the characters that a header may have, for `decodeURIComponent`.
fn percent_encoded(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte);
    text.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}
