//! Progress bars: on a terminal only, and only for what takes a while.

use std::sync::mpsc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kelir_render::Meter;

/// A bar with count and time left; silent when standard error is no terminal (indicatif sees to that).
pub(crate) fn bar(total: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{msg:<32} {bar:30} {pos}/{len} {eta} left");
    bar.set_style(style.expect("the template is well-formed"));
    bar.set_message(what.to_owned());
    bar
}

/// A line that only says that something is under way, and for how long.
fn waiting(what: &str) -> ProgressBar {
    let line = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{msg:<32} {spinner} {elapsed}");
    line.set_style(style.expect("the template is well-formed"));
    line.set_message(what.to_owned());
    line
}

/// Runs `work`, which may count its rows in `meter`; once it has taken a second a bar shows them, or a line that it is under way.
pub(crate) fn watch<T>(meter: &Meter, what: &str, work: impl FnOnce() -> T) -> T {
    let (done, finished) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let begun = Instant::now();
            let (mut shown, mut waits): (Option<ProgressBar>, Option<ProgressBar>) = (None, None);
            // Ends when `done` is dropped.
            while finished.recv_timeout(Duration::from_millis(100)) == Err(mpsc::RecvTimeoutError::Timeout) {
                let (rows, of) = meter.read();
                if begun.elapsed() < Duration::from_secs(1) {
                    continue;
                }
                if of == 0 || rows == of {
                    waits.get_or_insert_with(|| waiting(what)).tick();
                } else {
                    waits.take().inspect(ProgressBar::finish_and_clear);
                    let bar = shown.get_or_insert_with(|| bar(of, what));
                    bar.set_length(of);
                    bar.set_position(rows);
                }
            }
            shown.into_iter().chain(waits).for_each(|bar| bar.finish_and_clear());
        });
        let answer = work();
        drop(done);
        answer
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn watching_changes_nothing_and_ends_with_the_work() {
        let meter = Meter::default();
        let count = || {
            meter.begin(3);
            (0..3).for_each(|_| meter.add(1));
            meter.read()
        };
        assert_eq!(watch(&meter, "rows", count), (3, 3));
    }
}
