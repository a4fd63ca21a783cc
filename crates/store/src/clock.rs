//! Times as the database holds them: ISO-8601 UTC with milliseconds, of fixed width, so that text order is time order.

use jiff::{SignedDuration, Timestamp};
use std::time::Duration;

pub(crate) fn now() -> String {
    format!("{:.3}", Timestamp::now())
}

/// The time `ago` before now; the beginning of time where that does not exist.
pub(crate) fn before_now(ago: Duration) -> String {
    shifted(ago, |now, by| now.checked_sub(by))
}

/// The time `ahead` after now.
pub(crate) fn after_now(ahead: Duration) -> String {
    shifted(ahead, |now, by| now.checked_add(by))
}

fn shifted(
    by: Duration,
    shift: impl Fn(Timestamp, SignedDuration) -> Result<Timestamp, jiff::Error>,
) -> String {
    let moved = SignedDuration::try_from(by).ok().and_then(|by| shift(Timestamp::now(), by).ok());
    format!("{:.3}", moved.unwrap_or(Timestamp::UNIX_EPOCH))
}

/// A time as the database holds it in µs since 1970; `None` where the text is none.
pub fn micros(text: &str) -> Option<i64> {
    text.parse::<Timestamp>().ok().map(Timestamp::as_microsecond)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_one_width_and_sort_as_text() {
        let (past, present, future) =
            (before_now(Duration::from_secs(60)), now(), after_now(Duration::from_secs(60)));
        assert_eq!([past.len(), present.len(), future.len()], [24; 3], "{present}");
        assert!(past < present && present < future);
    }
}
