//! A line of the log that a flood can't flood.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// At most one line in so long.
const PAUSE: Duration = Duration::from_secs(10);

/// Says a thing at most once in ten seconds, and how often it was left unsaid before.
#[derive(Debug, Default)]
pub(crate) struct Rarely {
    said: Mutex<(Option<Instant>, u64)>,
}

impl Rarely {
    /// Calls `line` with what to add about the times before, unless it was said lately.
    pub(crate) fn say(&self, line: impl FnOnce(&str)) {
        if let Some(unsaid) = self.due(Instant::now()) {
            let before = if unsaid == 0 { String::new() } else { format!(" ({unsaid} times more before)") };
            line(&before);
        }
    }

    fn due(&self, now: Instant) -> Option<u64> {
        let mut said = self.said.lock().unwrap_or_else(PoisonError::into_inner);
        if said.0.is_some_and(|last| now.saturating_duration_since(last) < PAUSE) {
            said.1 += 1;
            return None;
        }
        let unsaid = said.1;
        *said = (Some(now), 0);
        Some(unsaid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_is_said_once_and_counted() {
        let (rarely, now) = (Rarely::default(), Instant::now());
        assert_eq!(rarely.due(now), Some(0));
        assert_eq!((rarely.due(now), rarely.due(now)), (None, None));
        assert_eq!(rarely.due(now + PAUSE), Some(2));
        assert_eq!(rarely.due(now + PAUSE + PAUSE), Some(0));
    }
}
