//! The log of a running server: standard error, or a file of the data folder where a person is reading standard error.

mod file;
mod writer;

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::time::Duration;

use tracing::Subscriber;
use tracing_subscriber::filter::LevelFilter;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{EnvFilter, Layer, Registry, fmt};

use file::BoundedFile;
use writer::Writer;

/// The log's file in the data folder.
const NAME: &str = "server.log";
/// Bytes of the file before it is put aside; the one that was put aside before goes.
const MOST_BYTES: u64 = 8 << 20;

/// A log that has begun.
pub(crate) struct Log {
    writers: Vec<Writer>,
    /// The file that has all of it, where standard error has not.
    pub file: Option<PathBuf>,
}

impl Log {
    /// Begins the log of a server on a data folder. `KELIR_LOG` says what standard error gets; without it all, or warnings alone where it is a
    /// terminal, and then all goes into a file.
    pub(crate) fn begin(data: &Path) -> Log {
        let asked = EnvFilter::try_from_env("KELIR_LOG").ok();
        let file = (asked.is_none() && io::stderr().is_terminal()).then(|| data.join(NAME));
        let level = if file.is_some() { LevelFilter::WARN } else { LevelFilter::INFO };
        let stderr = Writer::new(io::stderr());
        let kept = file.as_ref().map(|path| Writer::new(BoundedFile::new(path, MOST_BYTES)));
        let on_stderr = lines::<Registry>(&stderr)
            .with_filter(asked.unwrap_or_else(|| EnvFilter::default().add_directive(level.into())));
        let in_file = kept.as_ref().map(|kept| lines(kept).with_filter(LevelFilter::INFO));
        tracing_subscriber::registry().with(on_stderr).with(in_file).init();
        Log { writers: std::iter::once(stderr).chain(kept).collect(), file }
    }

    /// Waits until what was said is written, for at most `limit` each.
    pub(crate) fn flush(&self, limit: Duration) {
        self.writers.iter().for_each(|writer| writer.flush(limit));
    }
}

/// Events as lines.
fn lines<S: Subscriber + for<'a> LookupSpan<'a>>(writer: &Writer) -> impl Layer<S> + use<S> {
    fmt::layer().with_ansi(false).with_writer(writer.clone())
}
