//! How often one address may try a password.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Tries of one address within the window before it has to wait.
const TRIES: usize = 8;
const WINDOW: Duration = Duration::from_secs(60);

/// Recent tries by address. In memory: it protects one process, and argon2's own cost protects the rest.
#[derive(Debug, Default)]
pub(crate) struct Limiter {
    tries: Mutex<HashMap<IpAddr, Vec<Instant>>>,
}

impl Limiter {
    /// Counts a try before it is judged, so that parallel ones count too; `Err` holds the seconds to wait.
    pub(crate) fn attempt(&self, who: IpAddr, now: Instant) -> Result<(), u64> {
        let mut tries = self.tries.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        tries.retain(|_, times| {
            times.retain(|time| now.duration_since(*time) < WINDOW);
            !times.is_empty()
        });
        let times = tries.entry(who).or_default();
        match times.first() {
            Some(first) if times.len() >= TRIES => Err((WINDOW - now.duration_since(*first)).as_secs() + 1),
            _ => {
                times.push(now);
                Ok(())
            }
        }
    }

    /// Forgets an address's tries after a right password.
    pub(crate) fn forgive(&self, who: IpAddr) {
        self.tries.lock().unwrap_or_else(std::sync::PoisonError::into_inner).remove(&who);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::Ipv4Addr;

    #[test]
    fn the_ninth_try_within_a_minute_waits_and_others_do_not() {
        let (limiter, now) = (Limiter::default(), Instant::now());
        let (a, b) = (IpAddr::from(Ipv4Addr::LOCALHOST), IpAddr::from(Ipv4Addr::UNSPECIFIED));
        assert!((0..TRIES).all(|_| limiter.attempt(a, now).is_ok()));
        assert_eq!(limiter.attempt(a, now + Duration::from_secs(20)), Err(41));
        assert!(limiter.attempt(b, now).is_ok());
        assert!(limiter.attempt(a, now + WINDOW).is_ok());
        limiter.forgive(a);
        assert!((0..TRIES).all(|_| limiter.attempt(a, now + WINDOW).is_ok()));
    }
}
