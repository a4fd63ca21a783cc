//! HTTP/1.1 as bytes: what no client would send can be sent, and an answer can be left unread.

use serde_json::Value;
use std::io::{BufRead, BufReader, Error, ErrorKind, Result, Write};
use std::net::TcpStream;
use std::time::Duration;

/// Longer than the server waits for a lock, and than its delays at sign-in.
const PATIENCE: Duration = Duration::from_secs(20);

/// A connection that is kept, and opened anew where it has gone.
pub struct Wire {
    port: u16,
    stream: Option<BufReader<TcpStream>>,
}

/// What came back.
#[derive(Debug)]
pub struct Reply {
    /// The HTTP status.
    pub status: u16,
    /// The head, in small letters.
    pub head: String,
    /// The body's bytes.
    pub body: Vec<u8>,
}

impl Reply {
    /// The body as JSON; null where it is none.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_default()
    }

    /// The body's text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// A header's value.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.head.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(": "))
    }
}

/// A request's bytes; a body is sent as JSON.
pub fn request(method: &str, path: &str, headers: &[(&str, &str)], body: Option<&[u8]>) -> Vec<u8> {
    let mut head = format!("{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n");
    for (name, value) in headers {
        head.push_str(&format!("{name}: {value}\r\n"));
    }
    if let Some(body) = body {
        head.push_str(&format!("Content-Length: {}\r\n", body.len()));
    }
    let mut bytes = head.into_bytes();
    bytes.extend(b"\r\n");
    bytes.extend(body.unwrap_or_default());
    bytes
}

/// A request with a token and JSON, as the participant's page sends it.
pub fn ask(method: &str, path: &str, token: &str, body: &str) -> Vec<u8> {
    let bearer = format!("Bearer {token}");
    let headers = [("Content-Type", "application/json"), ("Authorization", bearer.as_str())];
    request(method, path, &headers, Some(body.as_bytes()))
}

impl Wire {
    /// To a server of this machine.
    pub fn new(port: u16) -> Wire {
        Wire { port, stream: None }
    }

    /// Sends a request and reads its answer.
    ///
    /// # Errors
    /// The connection ends, or nothing comes for a while; the next request opens another.
    pub fn send(&mut self, request: &[u8]) -> Result<Reply> {
        let mut stream = match self.stream.take() {
            Some(stream) => stream,
            None => BufReader::new(connect(self.port)?),
        };
        stream.get_mut().write_all(request)?;
        let reply = read(&mut stream, request.starts_with(b"HEAD "))?;
        if reply.header("connection") != Some("close") {
            self.stream = Some(stream);
        }
        Ok(reply)
    }

    /// Sends a request and goes away after a while without having read.
    ///
    /// # Errors
    /// There is no server.
    pub fn abandon(&self, request: &[u8], after: Duration) -> Result<()> {
        let mut stream = connect(self.port)?;
        stream.write_all(request)?;
        std::thread::sleep(after);
        Ok(())
    }
}

/// A connection that nothing has been sent over.
///
/// # Errors
/// There is no server.
pub fn connect(port: u16) -> Result<TcpStream> {
    let stream = TcpStream::connect(("127.0.0.1", port))?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    Ok(stream)
}

fn read(stream: &mut impl BufRead, is_head: bool) -> Result<Reply> {
    let mut head = String::new();
    while !head.ends_with("\r\n\r\n") {
        if stream.read_line(&mut head)? == 0 {
            return Err(Error::new(ErrorKind::UnexpectedEof, "the connection ended"));
        }
    }
    let head = head.to_ascii_lowercase();
    let status = head.split(' ').nth(1).and_then(|word| word.parse().ok());
    let status: u16 = status.ok_or_else(|| Error::new(ErrorKind::InvalidData, "no status"))?;
    let mut reply = Reply { status, head, body: Vec::new() };
    if is_head || matches!(status, 100..200 | 204 | 304) {
        return Ok(reply);
    }
    if reply.header("transfer-encoding") == Some("chunked") {
        reply.body = chunks(stream)?;
    } else if let Some(length) = reply.header("content-length").and_then(|length| length.parse().ok()) {
        reply.body = vec![0; length];
        stream.read_exact(&mut reply.body)?;
    } else {
        stream.read_to_end(&mut reply.body)?;
    }
    Ok(reply)
}

fn chunks(stream: &mut impl BufRead) -> Result<Vec<u8>> {
    let mut body = Vec::new();
    loop {
        let mut line = String::new();
        stream.read_line(&mut line)?;
        let size = usize::from_str_radix(line.trim_end(), 16);
        let size = size.map_err(|_| Error::new(ErrorKind::InvalidData, "no chunk"))?;
        let mut chunk = vec![0; size + 2];
        stream.read_exact(&mut chunk)?;
        if size == 0 {
            return Ok(body);
        }
        body.extend(&chunk[..size]);
    }
}
