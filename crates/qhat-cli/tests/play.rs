//! `qhat play`: serves the page, to this machine only.

#[test]
#[cfg(not(feature = "page"))]
fn a_command_without_its_page_says_how_to_get_one() {
    crate::common::Folder::new().qhat(&["play", "--no-open"]).refused("`make play` builds one");
}

#[cfg(feature = "page")]
mod served {
    use crate::common::{Folder, PENDULUM, QHAT};
    use std::io::{BufRead, BufReader, Read, Write};
    use std::net::TcpStream;
    use std::process::{Child, Command, Stdio};

    /// A command that serves until this value is dropped.
    struct Server {
        child: Child,
        address: String,
    }

    impl Server {
        fn start(folder: &Folder, arguments: &[&str]) -> Self {
            let mut command = Command::new(QHAT);
            command.args(["play", "--no-open"]).args(arguments).current_dir(folder.root());
            let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
            let mut said = String::new();
            BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut said).unwrap();
            let address = said.split("http://").nth(1).and_then(|rest| rest.split('/').next());
            let address = address.unwrap_or_else(|| panic!("no address in {said:?}")).to_owned();
            assert!(address.starts_with("127.0.0.1:"), "{said}");
            Server { child, address }
        }

        /// The head and the body of the answer to these lines.
        fn ask(&self, request: &str) -> (String, Vec<u8>) {
            let mut stream = TcpStream::connect(&self.address).unwrap();
            stream.write_all(request.as_bytes()).unwrap();
            let mut answer = Vec::new();
            stream.read_to_end(&mut answer).unwrap();
            let end = answer.windows(4).position(|w| w == b"\r\n\r\n").expect("a head");
            (String::from_utf8(answer[..end].to_vec()).unwrap(), answer[end + 4..].to_vec())
        }

        fn get(&self, path: &str) -> (String, Vec<u8>) {
            self.ask(&format!("GET {path} HTTP/1.1\r\nHost: {}\r\n\r\n", self.address))
        }
    }

    impl Drop for Server {
        fn drop(&mut self) {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }

    #[test]
    fn serves_the_page_with_its_types_and_guards() {
        let server = Server::start(&Folder::new(), &[]);
        let (head, body) = server.get("/");
        assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
        assert!(head.contains("Content-Type: text/html; charset=utf-8"), "{head}");
        assert!(head.contains(&format!("Content-Length: {}", body.len())), "{head}");
        for guard in ["frame-ancestors 'none'", "nosniff", "no-referrer", "Cache-Control: no-cache", "same-origin"] {
            assert!(head.contains(guard), "{guard} in {head}");
        }
        let page = String::from_utf8(body).unwrap();
        assert!(page.contains("<title>qhat</title>"), "{page}");
        // All files that the page requests are served with the correct type.
        let addresses: Vec<&str> = page.split(['"', '\'']).filter_map(|part| part.strip_prefix("./")).collect();
        for ending in [".js", ".css"] {
            assert!(addresses.iter().any(|address| address.ends_with(ending)), "no {ending} file in {page}");
        }
        for address in addresses {
            let (head, _) = server.get(&format!("/{address}?query"));
            assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{address}: {head}");
            let expected = match address.rsplit('.').next() {
                Some("js") => "text/javascript",
                Some("css") => "text/css",
                Some("svg") => "image/svg+xml",
                _ => "",
            };
            assert!(head.contains(&format!("Content-Type: {expected}")), "{address}: {head}");
        }
    }

    #[test]
    fn webassembly_has_the_type_that_browsers_ask_for() {
        let dist = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../playground/dist/assets");
        let names = std::fs::read_dir(dist).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let server = Server::start(&Folder::new(), &[]);
        let names: Vec<String> = names.filter(|name| name.ends_with(".wasm")).collect();
        assert!(!names.is_empty(), "the engine is in the page");
        for name in names {
            let (head, body) = server.get(&format!("/assets/{name}"));
            assert!(head.contains("Content-Type: application/wasm"), "{head}");
            assert_eq!(&body[..4], b"\0asm");
        }
    }

    #[test]
    fn hands_over_the_scene() {
        let folder = Folder::with(&[("mein Bäumchen.toml", PENDULUM)]);
        let server = Server::start(&folder, &["mein Bäumchen.toml"]);
        let (head, body) = server.get("/scene");
        assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{head}");
        assert!(head.contains("X-Qhat-Scene-Name: mein%20B%C3%A4umchen.toml"), "{head}");
        assert_eq!(body, PENDULUM.as_bytes());

        // A file that was edited after the start is read again, so that a reload of the page shows the change.
        let edited = PENDULUM.replace("A bob", "Another bob");
        std::fs::write(folder.path("mein Bäumchen.toml"), &edited).unwrap();
        assert_eq!(server.get("/scene").1, edited.as_bytes());

        let shipped = Server::start(&Folder::new(), &["pendulum"]);
        assert!(shipped.get("/scene").0.contains("X-Qhat-Scene-Name: pendulum.toml"));
        let (head, body) = Server::start(&Folder::new(), &[]).get("/scene");
        assert!(head.starts_with("HTTP/1.1 204 No Content\r\n") && body.is_empty(), "{head}");
    }

    #[test]
    fn refuses_what_is_not_its_business() {
        let server = Server::start(&Folder::new(), &["pendulum"]);
        let host = &server.address;
        let status = |request: &str| server.ask(request).0.lines().next().unwrap().to_owned();
        // A foreign page whose host name points to this server must not read the scene.
        assert_eq!(status("GET /scene HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "HTTP/1.1 403 Forbidden");
        assert_eq!(status("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"), "HTTP/1.1 403 Forbidden");
        assert_eq!(status("GET / HTTP/1.1\r\n\r\n"), "HTTP/1.1 403 Forbidden");
        assert_eq!(
            status(&format!("GET / HTTP/1.1\r\nHost: {host}\r\nHost: evil.example\r\n\r\n")),
            "HTTP/1.1 403 Forbidden"
        );
        let local = host.replace("127.0.0.1", "localhost");
        assert_eq!(status(&format!("GET / HTTP/1.1\r\nhost: {local}\r\n\r\n")), "HTTP/1.1 200 OK");
        assert_eq!(status(&format!("POST / HTTP/1.1\r\nHost: {host}\r\n\r\n")), "HTTP/1.1 405 Method Not Allowed");
        for path in ["/nothing", "/../Cargo.toml", "/%2e%2e/Cargo.toml", "//etc/passwd"] {
            let answer = status(&format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n"));
            assert_eq!(answer, "HTTP/1.1 404 Not Found", "{path}");
        }
        assert_eq!(status("what?\r\n\r\n"), "HTTP/1.1 400 Bad Request");
        let long = format!("GET / HTTP/1.1\r\nHost: {host}\r\nX: {}", "x".repeat(20_000));
        assert!(status(&long).starts_with("HTTP/1.1 431"), "a request that never ends");
        let (head, body) = server.ask(&format!("HEAD / HTTP/1.1\r\nHost: {host}\r\n\r\n"));
        assert!(head.starts_with("HTTP/1.1 200 OK") && body.is_empty());
    }

    #[test]
    fn a_broken_scene_or_a_taken_port_is_told_before_anything_is_served() {
        let folder = Folder::with(&[("bob.toml", &PENDULUM.replace("mass", "mess"))]);
        folder.qhat(&["play", "--no-open", "bob.toml"]).refused("bob.toml:7:");
        let server = Server::start(&folder, &[]);
        let port = server.address.rsplit(':').next().unwrap();
        folder.qhat(&["play", "--no-open", "--port", port]).refused(&format!("cannot listen on port {port}"));
    }
}
