//! A client of plain HTTP/1.1 over connections that are kept, the same for both sides.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use tokio::net::TcpStream;

/// The text of a request with a JSON body.
pub(super) fn request(method: &str, path: &str, token: &str, body: &str) -> String {
    format!(
        "{method} {path} HTTP/1.1\r\nHost: kelir\r\nAuthorization: Bearer {token}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    )
}

/// A connection, with what it has read ahead.
pub(super) struct Connection {
    stream: TcpStream,
    read: Vec<u8>,
}

impl Connection {
    pub(super) async fn open(address: SocketAddr) -> Result<Connection> {
        let stream = TcpStream::connect(address).await.context("the server does not answer")?;
        stream.set_nodelay(true)?;
        Ok(Connection { stream, read: Vec::new() })
    }

    /// Sends a request and reads the body of its answer, which must be a success.
    pub(super) async fn send(&mut self, request: &str) -> Result<Vec<u8>> {
        let mut rest = request.as_bytes();
        while !rest.is_empty() {
            self.stream.writable().await?;
            match self.stream.try_write(rest) {
                Ok(n) => rest = &rest[n..],
                Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                Err(error) => return Err(error.into()),
            }
        }
        loop {
            if let Some((head, length)) = head(&self.read)?
                && self.read.len() >= head + length
            {
                let body = self.read[head..head + length].to_vec();
                self.read.drain(..head + length);
                return Ok(body);
            }
            self.stream.readable().await?;
            let mut more = [0; 4096];
            match self.stream.try_read(&mut more) {
                Ok(0) => anyhow::bail!("the server closed the connection"),
                Ok(n) => self.read.extend_from_slice(&more[..n]),
                Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
}

/// Lengths of an answer's head and body; `None` while the head is not whole.
fn head(read: &[u8]) -> Result<Option<(usize, usize)>> {
    let Some(end) = read.windows(4).position(|bytes| bytes == b"\r\n\r\n") else { return Ok(None) };
    let head = String::from_utf8_lossy(&read[..end]).to_ascii_lowercase();
    let status = head.split(' ').nth(1).unwrap_or_default();
    ensure!(status.starts_with('2'), "the server answered {status}");
    let length = head.lines().find_map(|line| line.strip_prefix("content-length:"));
    Ok(Some((end + 4, length.context("an answer without Content-Length")?.trim().parse()?)))
}

/// Times that answers took, in ms, and how many came a second.
pub(super) struct Times {
    sorted_ms: Vec<f64>,
    pub per_s: f64,
}

impl Times {
    fn new(mut ms: Vec<f64>, took: Duration) -> Times {
        ms.sort_by(f64::total_cmp);
        Times { per_s: ms.len() as f64 / took.as_secs_f64(), sorted_ms: ms }
    }

    /// The smallest time that a part `q` of all did not exceed.
    pub(super) fn quantile_ms(&self, q: f64) -> f64 {
        let last = self.sorted_ms.len().saturating_sub(1);
        self.sorted_ms.get((last as f64 * q).ceil() as usize).copied().unwrap_or(f64::NAN)
    }
}

/// Sends every request over so many connections, each as soon as the one before it on its connection is answered.
pub(super) async fn saturate(
    address: SocketAddr,
    connections: usize,
    requests: Vec<String>,
) -> Result<(Vec<Vec<u8>>, Times)> {
    let (requests, next) = (Arc::new(requests), Arc::new(AtomicUsize::new(0)));
    let started = Instant::now();
    let senders: Vec<_> = (0..connections)
        .map(|_| {
            let (requests, next) = (requests.clone(), next.clone());
            tokio::spawn(async move {
                let mut connection = Connection::open(address).await?;
                let mut answers = Vec::new();
                while let Some(request) = requests.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let sent = Instant::now();
                    let body = connection.send(request).await?;
                    answers.push((body, sent.elapsed().as_secs_f64() * 1e3));
                }
                anyhow::Ok(answers)
            })
        })
        .collect();
    let (mut bodies, mut ms) = (Vec::new(), Vec::new());
    for sender in senders {
        for (body, took) in sender.await?? {
            bodies.push(body);
            ms.push(took);
        }
    }
    Ok((bodies, Times::new(ms, started.elapsed())))
}

/// One connection a person; each sends a request every `every`, from the moment that it should have gone.
pub(super) async fn pace(address: SocketAddr, people: Vec<Vec<String>>, every: Duration) -> Result<Times> {
    let n = people.len() as f64;
    let mut senders = Vec::new();
    let mut connections = Vec::new();
    for _ in &people {
        connections.push(Connection::open(address).await?);
    }
    let started = Instant::now();
    for (i, (requests, mut connection)) in people.into_iter().zip(connections).enumerate() {
        let first = started + every.mul_f64(i as f64 / n);
        senders.push(tokio::spawn(async move {
            let mut ms = Vec::new();
            for (turn, request) in (0u32..).zip(&requests) {
                let due = first + every * turn;
                tokio::time::sleep_until(due.into()).await;
                connection.send(request).await?;
                ms.push(due.elapsed().as_secs_f64() * 1e3);
            }
            anyhow::Ok(ms)
        }));
    }
    let mut ms = Vec::new();
    for sender in senders {
        ms.extend(sender.await??);
    }
    Ok(Times::new(ms, started.elapsed()))
}
