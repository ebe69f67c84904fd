//! A small HTTP server for one page on one machine: one request a connection, of bounded size and time.

use super::answer::{Answer, answer};
use crate::failure::{Failure, warn};
use crate::source::Source;
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// The first port that is tried; it is registered for no other service.
const FIRST_PORT: u16 = 7407;
/// The number of ports that are tried, enough for several scenes at once.
const PORTS_TRIED: u16 = 20;
/// The most bytes of a request; browsers send about a thousand.
const LONGEST_REQUEST: usize = 16 << 10;
/// The most headers of a request; browsers send about twenty.
const MOST_HEADERS: usize = 64;
/// The most connections at once; a browser opens six for a page.
const MOST_CONNECTIONS: usize = 64;
/// The longest wait for a request or an answer. On one machine a longer one is a hang.
const PATIENCE: Duration = Duration::from_secs(10);

/// Listens on a port of 127.0.0.1; without a port, or with 0, on the first that is free.
pub(crate) fn listen(port: Option<u16>) -> Result<TcpListener, Failure> {
    let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    match port {
        Some(port) if port != 0 => bind(port).map_err(|error| {
            Failure::io(format!("cannot listen on port {port} (another may do; without --port qhat finds one)"), &error)
        }),
        _ => {
            let free = (FIRST_PORT..FIRST_PORT + PORTS_TRIED).find_map(|port| bind(port).ok());
            // 0 lets the system choose.
            free.map_or_else(|| bind(0), Ok).map_err(|error| Failure::io("cannot listen on any port", &error))
        }
    }
}

/// Opens the address in a browser. Prints a message where no browser can be opened.
pub(crate) fn open(address: &str) {
    let address = address.to_owned();
    // Some openers return when their browser is closed, so that a thread of its own waits.
    thread::spawn(move || {
        if !has_display() || opener::open_browser(&address).is_err() {
            warn("no browser could be opened; open the address in one yourself");
        }
    });
}

/// Whether there is a display. Without one an opener may start a text browser in the terminal of the command.
fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || ["DISPLAY", "WAYLAND_DISPLAY", "BROWSER"].into_iter().any(set)
}

/// Answers until the process ends.
pub(crate) fn serve(listener: &TcpListener, scene: Option<Source>) -> Result<ExitCode, Failure> {
    let port = listener.local_addr().map_err(|error| Failure::io("cannot listen", &error))?.port();
    let scene = Arc::new(scene);
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        // Errors of one connection (broken early, too many open files) do not concern the next.
        let Ok(stream) = stream else { continue };
        let slot = Slot::take(&open);
        if slot.is_none() {
            continue;
        }
        let scene = Arc::clone(&scene);
        let worker = move || {
            let _slot = slot;
            // An error means that the other side has closed the connection.
            let _ = converse(stream, port, scene.as_ref().as_ref());
        };
        // Where no thread can be started, the connection is dropped.
        let _ = thread::Builder::new().spawn(worker);
    }
    Ok(ExitCode::SUCCESS)
}

/// A slot for a connection, freed when dropped.
struct Slot(Arc<AtomicUsize>);

impl Slot {
    fn take(open: &Arc<AtomicUsize>) -> Option<Slot> {
        let slot = Slot(Arc::clone(open));
        (open.fetch_add(1, Ordering::Relaxed) < MOST_CONNECTIONS).then_some(slot)
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

fn converse(mut stream: TcpStream, port: u16, scene: Option<&Source>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let began = Instant::now();
    let mut request = Vec::new();
    let mut part = [0; 2048];
    let bytes = loop {
        let read = stream.read(&mut part)?;
        if read == 0 || began.elapsed() > PATIENCE {
            return Ok(());
        }
        request.extend_from_slice(&part[..read]);
        if let Some(bytes) = answer_to(&request, port, scene) {
            break bytes;
        }
    };
    stream.write_all(&bytes)?;
    stream.shutdown(Shutdown::Write)
}

/// The answer to a request; none before its head is complete.
fn answer_to(request: &[u8], port: u16, scene: Option<&Source>) -> Option<Vec<u8>> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    match parsed.parse(request) {
        Ok(httparse::Status::Complete(_)) => {}
        Ok(httparse::Status::Partial) if request.len() <= LONGEST_REQUEST => return None,
        Ok(httparse::Status::Partial) | Err(httparse::Error::TooManyHeaders) => {
            return Some(
                Answer::refusal("431 Request Header Fields Too Large", "the request is too long").bytes(false),
            );
        }
        Err(_) => return Some(Answer::refusal("400 Bad Request", "that is not HTTP").bytes(false)),
    }
    let (method, target) = (parsed.method.unwrap_or_default(), parsed.path.unwrap_or_default());
    let mut hosts = parsed.headers.iter().filter(|header| header.name.eq_ignore_ascii_case("host"));
    let host = hosts.next().and_then(|header| std::str::from_utf8(header.value).ok());
    // With two Host headers neither can be trusted.
    let host = if hosts.next().is_some() { None } else { host };
    let path = target.split(['?', '#']).next().unwrap_or_default();
    Some(answer(method, path, host, port, scene).bytes(method == "HEAD"))
}
