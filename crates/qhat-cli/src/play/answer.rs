//! What the server answers to one request; nothing here touches a socket.

use super::page;
use crate::source::Source;
use std::borrow::Cow;

/// The page runs its own script and its own WebAssembly, talks to its own server, and is shown in no other page's frame.
const CONTENT_SECURITY_POLICY: &str = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; object-src 'none'; \
                                       base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// With every answer.
const HEADERS: [(&str, &str); 7] = [
    ("Content-Security-Policy", CONTENT_SECURITY_POLICY),
    ("X-Content-Type-Options", "nosniff"),
    ("X-Frame-Options", "DENY"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Opener-Policy", "same-origin"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    // Another qhat, or another scene, may be at this address in a minute.
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

    /// A line of text for a request that gets nothing else.
    pub(crate) fn refusal(status: &'static str, why: &'static str) -> Self {
        Answer::new(status, "text/plain; charset=utf-8", format!("{why}\n").into_bytes())
    }

    /// The bytes to send; without the body where only the head was asked for.
    pub(crate) fn bytes(&self, head_only: bool) -> Vec<u8> {
        let mut head = format!("HTTP/1.1 {}\r\nConnection: close\r\n", self.status);
        let own = self.headers.iter().map(|(name, value)| (*name, value.as_str()));
        for (name, value) in own.chain(HEADERS) {
            head += &format!("{name}: {value}\r\n");
        }
        // An answer without content has no length either.
        if !self.status.starts_with("204") {
            head += &format!("Content-Length: {}\r\n", self.body.len());
        }
        head += "\r\n";
        let body: &[u8] = if head_only { &[] } else { &self.body };
        [head.as_bytes(), body].concat()
    }
}

/// Answers a request for a path (without its query), said to be for `host`, by a server that listens on `port`.
pub(crate) fn answer(method: &str, path: &str, host: Option<&str>, port: u16, scene: Option<&Source>) -> Answer {
    // A foreign name that was made to point here (DNS rebinding) would let a foreign page read what this one serves.
    let own = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    if !host.is_some_and(|host| own.iter().any(|own| own.eq_ignore_ascii_case(host))) {
        return Answer::refusal("403 Forbidden", "qhat answers only to 127.0.0.1 and localhost");
    }
    if !matches!(method, "GET" | "HEAD") {
        let mut answer = Answer::refusal("405 Method Not Allowed", "qhat only hands things out");
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

/// That there is no scene is an answer, and no error that belongs in the browser's console.
fn no_scene() -> Answer {
    Answer { status: "204 No Content", headers: Vec::new(), body: Cow::Borrowed(&[]) }
}

/// A text in the characters that a header may have, as `decodeURIComponent` reads it.
fn percent_encoded(text: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte);
    text.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}
