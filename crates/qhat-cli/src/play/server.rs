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

/// q-h-a-t has four letters, and nobody else has this port.
const FIRST_PORT: u16 = 7407;
/// A person plays with a few scenes at once, not with more.
const PORTS_TRIED: u16 = 20;
/// Browsers send about a kilobyte [bytes].
const LONGEST_REQUEST: usize = 16 << 10;
/// Browsers send about twenty.
const MOST_HEADERS: usize = 64;
/// A browser opens six connections a page.
const MOST_CONNECTIONS: usize = 64;
/// On one machine anything longer is a hang.
const PATIENCE: Duration = Duration::from_secs(10);

/// Listens on a port of 127.0.0.1; without one (or with 0) on the first that is free.
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

/// Opens the address in a browser, and says so if there is none.
pub(crate) fn open(address: &str) {
    let address = address.to_owned();
    // Some openers return only when their browser is closed.
    thread::spawn(move || {
        if !has_display() || opener::open_browser(&address).is_err() {
            warn("no browser could be opened; open the address in one yourself");
        }
    });
}

/// On a machine without a display an opener may start a browser of letters in the very terminal qhat is in.
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
        // A connection that broke before it was taken, or too many open files: the next may do.
        let Ok(stream) = stream else { continue };
        let place = Place::take(&open);
        if place.is_none() {
            continue;
        }
        let scene = Arc::clone(&scene);
        let worker = move || {
            let _place = place;
            // Whoever hung up in the middle is not there to be told.
            let _ = converse(stream, port, scene.as_ref().as_ref());
        };
        // Where there is no thread to be had, the connection is dropped.
        let _ = thread::Builder::new().spawn(worker);
    }
    Ok(ExitCode::SUCCESS)
}

/// One of the places for connections, free again when dropped.
struct Place(Arc<AtomicUsize>);

impl Place {
    fn take(open: &Arc<AtomicUsize>) -> Option<Place> {
        let place = Place(Arc::clone(open));
        (open.fetch_add(1, Ordering::Relaxed) < MOST_CONNECTIONS).then_some(place)
    }
}

impl Drop for Place {
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

/// The answer to a request, as soon as all of its head is there.
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
    // Two hosts are one too many to trust either.
    let host = if hosts.next().is_some() { None } else { host };
    let path = target.split(['?', '#']).next().unwrap_or_default();
    Some(answer(method, path, host, port, scene).bytes(method == "HEAD"))
}
