//! Lines are written by a thread of its own, so that a slow, full or closed log costs no request anything.

use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, TrySendError, channel, sync_channel};
use std::time::Duration;

use tracing_subscriber::fmt::MakeWriter;

/// Lines that may wait to be written; what comes beyond them is counted and dropped.
const WAITING: usize = 8192;

/// Where lines go that must not be waited for.
#[derive(Clone)]
pub struct Writer {
    lines: SyncSender<Message>,
    dropped: Arc<AtomicU64>,
}

enum Message {
    Line(Vec<u8>),
    /// All before it is written.
    Flush(Sender<()>),
}

impl Writer {
    /// Writes to `out` from a thread of its own; what `out` refuses is lost, and nothing else.
    pub fn new(out: impl Write + Send + 'static) -> Writer {
        let (lines, waiting) = sync_channel(WAITING);
        let dropped = Arc::new(AtomicU64::new(0));
        let counted = dropped.clone();
        // Without the thread nothing is written, which is what an unwritable log amounts to.
        let _ = std::thread::Builder::new()
            .name("log".to_owned())
            .spawn(move || write_all(out, &waiting, &counted));
        Writer { lines, dropped }
    }

    /// Waits until what was said is written, for at most `limit`.
    pub fn flush(&self, limit: Duration) {
        let (done, written) = channel();
        if self.lines.try_send(Message::Flush(done)).is_ok() {
            let _: Result<(), RecvTimeoutError> = written.recv_timeout(limit);
        }
    }
}

fn write_all(mut out: impl Write, waiting: &Receiver<Message>, dropped: &AtomicU64) {
    while let Ok(message) = waiting.recv() {
        match message {
            Message::Line(line) => {
                let lost = dropped.swap(0, Ordering::Relaxed);
                if lost > 0 {
                    let _ = writeln!(
                        out,
                        "{lost} lines of the log were lost: it could not be written fast enough"
                    );
                }
                let _ = out.write_all(&line);
            }
            Message::Flush(done) => {
                let _ = out.flush();
                let _ = done.send(());
            }
        }
    }
}

impl Write for &Writer {
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        if let Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) =
            self.lines.try_send(Message::Line(line.to_vec()))
        {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl<'a> MakeWriter<'a> for Writer {
    type Writer = &'a Writer;

    fn make_writer(&'a self) -> &'a Writer {
        self
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use std::sync::Mutex;

    #[derive(Clone, Default)]
    struct Shared(Arc<Mutex<Vec<u8>>>);

    impl Write for Shared {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    /// A pipe that nobody reads.
    struct Blocked(Receiver<()>);

    impl Write for Blocked {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            let _ = self.0.recv();
            Err(io::ErrorKind::BrokenPipe.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn lines_are_written_in_order() {
        let shared = Shared::default();
        let writer = Writer::new(shared.clone());
        for line in 0..100 {
            writeln!(&writer, "{line}").unwrap();
        }
        writer.flush(Duration::from_secs(60));
        let written = String::from_utf8(shared.0.lock().unwrap().clone()).unwrap();
        let lines: Vec<usize> = written.lines().map(|line| line.parse().unwrap()).collect();
        assert_eq!(lines, (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn what_cannot_be_written_is_dropped_and_counted() {
        let (_held, blocked) = channel();
        let writer = Writer::new(Blocked(blocked));
        for _ in 0..WAITING + 100 {
            assert_eq!((&writer).write(b"line\n").unwrap(), 5);
        }
        assert!(writer.dropped.load(Ordering::Relaxed) >= 99);
    }
}
