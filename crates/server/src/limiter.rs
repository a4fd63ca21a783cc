//! How long whoever tries passwords waits: a delay that grows with wrong ones and never a lock, so that the right password gets in.

use crate::address::Tally;
use std::net::{IpAddr, Ipv4Addr};
use std::time::{Duration, Instant};

/// Wrong passwords count for so long.
const WINDOW: Duration = Duration::from_secs(15 * 60);
/// Tries of one address that cost nothing; people mistype.
const FREE: usize = 3;
/// Wrong passwords from everywhere that cost nothing.
const FREE_IN_ALL: usize = 50;
/// The first delay, doubled by each wrong password after it, up to the longest.
const STEP: Duration = Duration::from_millis(250);
const LONGEST: Duration = Duration::from_secs(4);
/// Nobody's address, under which everybody's wrong passwords are counted.
const EVERYBODY: IpAddr = IpAddr::V4(Ipv4Addr::BROADCAST);

/// Recent wrong passwords. In memory: it protects one process, and argon2's own cost protects the rest.
#[derive(Debug)]
pub(crate) struct Limiter {
    wrong: Tally,
}

impl Default for Limiter {
    fn default() -> Limiter {
        Limiter { wrong: Tally::new(WINDOW) }
    }
}

impl Limiter {
    /// Counts a try as wrong before it is judged, so that parallel ones count too; answers how long it waits for its judgement.
    pub(crate) fn attempt(&self, who: IpAddr, now: Instant) -> Duration {
        delay(self.wrong.note(who, now), FREE)
    }

    /// Takes an address's wrong tries back after a right password.
    pub(crate) fn forgive(&self, who: IpAddr, now: Instant) {
        self.wrong.forget(who, now);
    }

    /// Counts a wrong password among everybody's; answers how long it waits to be told so. The right one never waits for this.
    pub(crate) fn refused(&self, now: Instant) -> Duration {
        delay(self.wrong.note(EVERYBODY, now), FREE_IN_ALL)
    }
}

fn delay(tries: usize, free: usize) -> Duration {
    let beyond = u32::try_from(tries.saturating_sub(free)).unwrap_or(u32::MAX);
    match beyond {
        0 => Duration::ZERO,
        n => STEP.saturating_mul(2u32.saturating_pow(n - 1)).min(LONGEST),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_grow_to_a_bound_by_address_and_are_forgiven() {
        let (limiter, now) = (Limiter::default(), Instant::now());
        let (a, b) = (IpAddr::from([192, 0, 2, 1]), IpAddr::from([192, 0, 2, 2]));
        let ms: Vec<u128> = (0..10).map(|_| limiter.attempt(a, now).as_millis()).collect();
        assert_eq!(ms, [0, 0, 0, 250, 500, 1000, 2000, 4000, 4000, 4000]);
        assert_eq!(limiter.attempt(b, now), Duration::ZERO, "another address");
        assert_eq!(limiter.attempt(a, now + WINDOW), Duration::ZERO, "long ago");
        assert!((0..200).all(|_| limiter.attempt(a, now) <= LONGEST), "never longer");
        limiter.forgive(a, now);
        assert_eq!(limiter.attempt(a, now), Duration::ZERO);
    }

    #[test]
    fn wrong_passwords_from_everywhere_slow_wrong_ones_alone() {
        let (limiter, now) = (Limiter::default(), Instant::now());
        assert!((0..FREE_IN_ALL).all(|_| limiter.refused(now).is_zero()));
        assert_eq!(limiter.refused(now), STEP);
        assert_eq!(limiter.attempt(IpAddr::from([192, 0, 2, 3]), now), Duration::ZERO);
    }
}
