//! Which connections there are, and whose place a newcomer takes where there are too many.
//!
//! A newcomer is never turned away while another connection is silent: whoever opens a thousand and says nothing loses the oldest of them.

use super::line::{Line, Phase};
use crate::address::Tally;
use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// An address that somebody takes part from with consent counts as known for so long: a laboratory shares one.
const KNOWN: Duration = Duration::from_secs(3600);

/// How many connections there may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Caps {
    /// In all.
    pub(crate) all: usize,
    /// Of one address that nobody is known to take part from.
    pub(crate) one_address: usize,
}

pub(crate) struct Registry {
    caps: Caps,
    lines: Mutex<HashMap<IpAddr, Vec<Arc<Line>>>>,
    known: Tally,
}

/// Why a connection was closed for another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Crowded {
    /// Too many of its address.
    Address,
    /// Too many in all.
    All,
}

impl Registry {
    pub(crate) fn new(caps: Caps) -> Registry {
        Registry { caps, lines: Mutex::default(), known: Tally::new(KNOWN) }
    }

    /// Somebody who has consented asks from this address.
    pub(crate) fn know(&self, address: IpAddr) {
        if self.known.count(address, Instant::now()).0 == 0 {
            self.known.note(address, Instant::now());
        }
    }

    /// A newcomer's line, and what had to go for it; `None` where every other connection is being answered. `exempt` are trusted proxies, which
    /// everybody comes through.
    pub(crate) fn admit(&self, network: IpAddr, exempt: bool) -> (Option<Arc<Line>>, Option<Crowded>) {
        let exempt = exempt || self.known.count(network, Instant::now()).0 > 0;
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        // One that was told to close goes in its own time; it no longer counts.
        lines.values_mut().for_each(|own| own.retain(|line| !line.is_closing()));
        let mut crowded = None;
        if !exempt && lines.get(&network).is_some_and(|own| own.len() >= self.caps.one_address) {
            crowded = Some(Crowded::Address);
            let own = lines.get(&network).into_iter().flatten();
            if !close_oldest(own) {
                return (None, crowded);
            }
        } else if lines.values().map(Vec::len).sum::<usize>() >= self.caps.all {
            crowded = Some(Crowded::All);
            let now = Instant::now();
            let unknown = lines.iter().filter(|(of, _)| self.known.count(**of, now).0 == 0);
            if !close_oldest(unknown.flat_map(|(_, own)| own)) && !close_oldest(lines.values().flatten()) {
                return (None, crowded);
            }
        }
        let line = Arc::new(Line::new(network));
        lines.entry(network).or_default().push(line.clone());
        (Some(line), crowded)
    }

    /// Closes the connection that has been silent for longest, for its descriptor.
    pub(crate) fn make_room(&self) {
        let lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        close_oldest(lines.values().flatten());
    }

    /// A connection has ended.
    pub(crate) fn leave(&self, line: &Arc<Line>) {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = lines.get_mut(&line.network) {
            own.retain(|other| !Arc::ptr_eq(other, line));
            if own.is_empty() {
                lines.remove(&line.network);
            }
        }
    }

    #[cfg(test)]
    fn len(&self) -> usize {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner).values().map(Vec::len).sum()
    }
}

/// Tells the line that has been at one thing for longest to close, but none that is being answered; whether there was one.
fn close_oldest<'a>(lines: impl IntoIterator<Item = &'a Arc<Line>>) -> bool {
    let open = lines.into_iter().filter(|line| line.phase() != Phase::Working && !line.is_closing());
    let oldest = open.min_by_key(|line| line.since());
    oldest.is_some_and(|line| {
        line.close();
        true
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    const A: IpAddr = IpAddr::V4(std::net::Ipv4Addr::new(192, 0, 2, 1));
    const B: IpAddr = IpAddr::V4(std::net::Ipv4Addr::new(192, 0, 2, 2));

    fn registry(all: usize, one_address: usize) -> Registry {
        Registry::new(Caps { all, one_address })
    }

    fn admit(registry: &Registry, address: IpAddr) -> Arc<Line> {
        // Lines are told apart by when they came, in ms.
        std::thread::sleep(Duration::from_millis(2));
        registry.admit(address, false).0.unwrap()
    }

    #[test]
    fn the_oldest_silent_connection_of_an_address_makes_room() {
        let registry = registry(100, 3);
        let other = admit(&registry, B);
        let [first, second, third] = [(); 3].map(|()| admit(&registry, A));
        second.enter(Phase::Working);
        let (line, why) = registry.admit(A, false);
        assert!(line.is_some() && why == Some(Crowded::Address) && first.is_closing());
        assert!(!second.is_closing() && !third.is_closing() && !other.is_closing());
        admit(&registry, A);
        assert!(!second.is_closing() && third.is_closing(), "what is being answered stays");
    }

    #[test]
    fn where_all_are_being_answered_a_newcomer_is_turned_away() {
        let registry = registry(100, 2);
        (0..2).for_each(|_| admit(&registry, A).enter(Phase::Working));
        let (line, why) = registry.admit(A, false);
        assert!(line.is_none() && why == Some(Crowded::Address));
        assert!(registry.admit(B, false).0.is_some());
    }

    #[test]
    fn a_known_address_and_a_proxy_are_held_to_the_cap_of_all_alone() {
        let registry = registry(6, 2);
        let stranger = admit(&registry, B);
        registry.know(A);
        let known: Vec<_> = (0..4).map(|_| admit(&registry, A)).collect();
        registry.admit(B, true);
        assert_eq!(registry.len(), 6);
        let (_, why) = registry.admit(A, false);
        assert_eq!(why, Some(Crowded::All));
        assert!(stranger.is_closing(), "strangers go first");
        assert!(known.iter().all(|line| !line.is_closing()));
    }

    #[test]
    fn what_has_ended_no_longer_counts() {
        let registry = registry(100, 2);
        let line = admit(&registry, A);
        registry.leave(&line);
        assert_eq!(registry.len(), 0);
        (0..2).for_each(|_| drop(admit(&registry, A)));
        registry.make_room();
        assert_eq!(registry.admit(A, false).1, None);
    }
}
