//! A running studio, and requests to it byte by byte.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::process::{Child, ExitStatus, Stdio};
use std::time::Duration;

use crate::bench::Bench;

/// Time limit after which a server counts as hung, even on a busy machine.
const HANG: Duration = Duration::from_secs(900);

/// The running command with the address that it printed.
pub struct Server {
    child: Child,
    pub port: u16,
    pub token: String,
}

/// An answer.
pub struct Reply {
    pub status: u16,
    pub head: String,
    pub body: String,
}

impl Reply {
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.body))
    }

    /// Value of a header.
    pub fn header(&self, name: &str) -> Option<&str> {
        let lines = self.head.lines().filter_map(|line| line.split_once(": "));
        lines.into_iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value)
    }
}

impl Server {
    /// Starts the server in the folder of a bench.
    pub fn start(bench: &Bench, arguments: &[&str]) -> Self {
        let all = [&["studio", "--no-browser"], arguments].concat();
        let mut child = bench.command(&all).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address =
            line.trim().strip_prefix("http://127.0.0.1:").unwrap_or_else(|| panic!("no address: {line:?}"));
        let (port, token) = address.split_once("/?token=").unwrap();
        Self { child, port: port.parse().unwrap(), token: token.into() }
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        stream.set_write_timeout(Some(HANG)).unwrap();
        stream
    }

    /// Head of a request with the token, to be continued.
    pub fn head(&self, method: &str, path: &str) -> String {
        let Self { port, token, .. } = self;
        format!(
            "{method} {path} HTTP/1.1\r\nhost: 127.0.0.1:{port}\r\nconnection: close\r\nx-hardpoint-token: {token}\r\n"
        )
    }

    /// Sends these bytes and reads the complete answer.
    pub fn raw(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = self.connect();
        // The server may close a rejected connection before it has read everything.
        let _ = stream.write_all(bytes);
        let mut reply = Vec::new();
        let _ = stream.read_to_end(&mut reply);
        reply
    }

    /// Sends a complete request unchanged.
    pub fn send(&self, request: &str) -> Reply {
        reply(&self.raw(request.as_bytes()))
    }

    pub fn get(&self, path: &str) -> Reply {
        self.send(&(self.head("GET", path) + "\r\n"))
    }

    /// Sends a request with headers, each with its line end, and a body.
    pub fn ask(&self, method: &str, path: &str, headers: &str, body: &str) -> Reply {
        let head = self.head(method, path);
        self.send(&format!("{head}{headers}content-length: {}\r\n\r\n{body}", body.len()))
    }

    /// Replaces the text of that revision.
    pub fn put(&self, query: &str, revision: &str, text: &str) -> Reply {
        self.ask("PUT", &format!("/api/model?{query}"), &format!("if-match: \"{revision}\"\r\n"), text)
    }

    pub fn revision(&self, file: &str) -> String {
        self.get(&format!("/api/model?file={file}")).json()["revision"].as_str().unwrap().into()
    }

    /// Events of a page.
    pub fn events(&self, query: &str) -> Events {
        let mut stream = self.connect();
        stream.write_all((self.head("GET", &format!("/api/events?{query}")) + "\r\n").as_bytes()).unwrap();
        Events(BufReader::new(stream))
    }

    /// Interrupts the server, as with Ctrl-C.
    pub fn interrupt(mut self) -> ExitStatus {
        let kill =
            std::process::Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        self.child.wait().unwrap()
    }

    pub fn kill(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.kill();
    }
}

/// A stream of events.
pub struct Events(BufReader<TcpStream>);

impl Events {
    /// Next event other than a sign of life.
    pub fn next(&mut self) -> (String, serde_json::Value) {
        let mut name = String::new();
        loop {
            let mut line = String::new();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the server has closed the stream of events");
            if let Some(event) = line.trim_end().strip_prefix("event: ") {
                name = event.into();
            } else if let Some(data) = line.trim_end().strip_prefix("data: ").filter(|_| name != "alive") {
                return (name, serde_json::from_str(data).unwrap());
            }
        }
    }

    /// Next event of that name.
    pub fn next_of(&mut self, wanted: &str) -> serde_json::Value {
        loop {
            let (name, data) = self.next();
            if name == wanted {
                return data;
            }
        }
    }
}

fn reply(bytes: &[u8]) -> Reply {
    let text = String::from_utf8_lossy(bytes);
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).unwrap_or(0);
    Reply { status, head: head.into(), body: body.into() }
}
