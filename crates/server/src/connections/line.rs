//! One connection as its guard sees it: what it is at, since when, and when its other end last moved a byte.

use std::io;
use std::net::IpAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::task::{Context, Poll};
use std::time::{Duration, Instant};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::sync::Notify;

/// What a connection is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Phase {
    /// No request has come whole up to its body.
    Waiting = 0,
    /// A body is coming.
    Receiving = 1,
    /// The request is here and is being answered.
    Working = 2,
    /// The answer is on its way.
    Sending = 3,
}

/// The longest that a connection may be silent, by what it is at; as long as bytes move, a slow line is left alone.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patience {
    /// Between requests, and for a request's head in all. Longer than proxies keep a connection, so that it is they who end it.
    pub(crate) waiting: Duration,
    /// Between two bytes of a body.
    pub(crate) receiving: Duration,
    /// For a body in all.
    pub(crate) body: Duration,
    /// Until the other end takes more of an answer.
    pub(crate) sending: Duration,
}

impl Default for Patience {
    fn default() -> Patience {
        Patience {
            waiting: Duration::from_secs(75),
            receiving: Duration::from_secs(45),
            body: Duration::from_secs(600),
            sending: Duration::from_secs(75),
        }
    }
}

#[derive(Debug)]
pub(crate) struct Line {
    /// The network that it comes from.
    pub(crate) network: IpAddr,
    closing: AtomicBool,
    closed: Notify,
    opened: Instant,
    phase: AtomicU8,
    /// When the phase began and when a byte last moved, in ms since `opened`.
    since_ms: AtomicU64,
    moved_ms: AtomicU64,
}

impl Line {
    pub(crate) fn new(network: IpAddr) -> Line {
        let (phase, since_ms, moved_ms) = Default::default();
        let (closing, closed) = (AtomicBool::new(false), Notify::new());
        Line { network, closing, closed, opened: Instant::now(), phase, since_ms, moved_ms }
    }

    pub(crate) fn phase(&self) -> Phase {
        match self.phase.load(Ordering::Relaxed) {
            0 => Phase::Waiting,
            1 => Phase::Receiving,
            2 => Phase::Working,
            _ => Phase::Sending,
        }
    }

    pub(crate) fn enter(&self, phase: Phase) {
        let now = self.now_ms();
        self.moved_ms.store(now, Ordering::Relaxed);
        self.since_ms.store(now, Ordering::Relaxed);
        self.phase.store(phase as u8, Ordering::Relaxed);
    }

    /// Ends the connection.
    pub(crate) fn close(&self) {
        self.closing.store(true, Ordering::Relaxed);
        self.closed.notify_one();
    }

    /// Whether it has been told to end.
    pub(crate) fn is_closing(&self) -> bool {
        self.closing.load(Ordering::Relaxed)
    }

    /// Returns once it is told to end.
    pub(crate) async fn told_to_close(&self) {
        self.closed.notified().await;
    }

    /// When its phase began.
    pub(crate) fn since(&self) -> Instant {
        self.opened + Duration::from_millis(self.since_ms.load(Ordering::Relaxed))
    }

    /// When patience with it ends, if nothing more happens; `None` while the server itself is at work.
    pub(crate) fn deadline(&self, patience: &Patience) -> Option<Instant> {
        let moved = self.opened + Duration::from_millis(self.moved_ms.load(Ordering::Relaxed));
        match self.phase() {
            Phase::Waiting => Some(self.since() + patience.waiting),
            Phase::Receiving => Some((moved + patience.receiving).min(self.since() + patience.body)),
            Phase::Working => None,
            Phase::Sending => Some(moved + patience.sending),
        }
    }

    fn now_ms(&self) -> u64 {
        u64::try_from(self.opened.elapsed().as_millis()).unwrap_or(u64::MAX)
    }
}

/// A stream that notes when bytes move.
pub(crate) struct Watched<T> {
    pub(crate) stream: T,
    pub(crate) line: Arc<Line>,
}

impl<T> Watched<T> {
    fn moved<R>(&self, polled: Poll<R>) -> Poll<R> {
        if polled.is_ready() {
            self.line.moved_ms.store(self.line.now_ms(), Ordering::Relaxed);
        }
        polled
    }
}

impl<T: AsyncRead + Unpin> AsyncRead for Watched<T> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let polled = Pin::new(&mut self.stream).poll_read(cx, buffer);
        self.moved(polled)
    }
}

impl<T: AsyncWrite + Unpin> AsyncWrite for Watched<T> {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.moved(polled)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        slices: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let polled = Pin::new(&mut self.stream).poll_write_vectored(cx, slices);
        self.moved(polled)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
