//! Where a request comes from, and counts of what one address did, which hold no address.

use crate::proxies::TrustedProxies;
use axum::http::HeaderMap;
use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;
use std::collections::{HashMap, VecDeque};
use std::net::{IpAddr, Ipv6Addr, SocketAddr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The last address of `X-Forwarded-For` that no trusted proxy has; the connection's own where its other end is not trusted.
pub(crate) fn client_address(peer: IpAddr, headers: &HeaderMap, trusted: &TrustedProxies) -> IpAddr {
    let mut client = peer.to_canonical();
    let lines = headers.get_all("x-forwarded-for").iter().rev();
    let mut hops = lines
        .flat_map(|line| line.to_str().unwrap_or_default().rsplit(','))
        .map(|hop| address_of(hop.trim()));
    while trusted.contains(client) {
        match hops.next() {
            Some(Some(hop)) => client = hop.to_canonical(),
            // Nothing said, or nothing that can be read: whatever came before is hearsay too.
            _ => break,
        }
    }
    client
}

/// An address as proxies write it: plain, with a port, in brackets.
fn address_of(text: &str) -> Option<IpAddr> {
    let with_port = || text.parse::<SocketAddr>().map(|address| address.ip());
    let bracketed = || text.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
    text.parse().or_else(|_| with_port()).or_else(|_| bracketed()).ok()
}

/// The address itself, or of IPv6 the /64 network, as one host has all of it.
pub(crate) fn network(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(address) => IpAddr::V6(Ipv6Addr::from_bits(address.to_bits() >> 64 << 64)),
        v4 => v4,
    }
}

/// How long a key lives, and with it all that was counted under it.
const DAY: Duration = Duration::from_secs(24 * 3600);
/// Addresses that are counted at one time; beyond them the one that was silent for longest is forgotten.
const MOST_ADDRESSES: usize = 1 << 16;
/// Events that are counted of one address.
const MOST_EVENTS: usize = 1 << 10;

/// What each address did lately. Addresses are known by an HMAC whose key is renewed daily and kept nowhere.
#[derive(Debug)]
pub(crate) struct Tally {
    window: Duration,
    counted: Mutex<Option<Counted>>,
}

#[derive(Debug)]
struct Counted {
    /// A block of the hash, random in its first half: as long a key as the HMAC has use for.
    key: [u8; 64],
    since: Instant,
    events: HashMap<[u8; 32], VecDeque<Instant>>,
}

impl Tally {
    /// Counts what happened within `window`, a day at most.
    pub(crate) fn new(window: Duration) -> Tally {
        Tally { window: window.min(DAY), counted: Mutex::default() }
    }

    /// Notes an event; answers how many there were of this address within the window, this one too.
    pub(crate) fn note(&self, who: IpAddr, now: Instant) -> usize {
        self.with(now, |counted, window| {
            let name = counted.name(who);
            if counted.events.len() >= MOST_ADDRESSES && !counted.events.contains_key(&name) {
                counted.make_room(window, now);
            }
            let events = counted.events.entry(name).or_default();
            recent(events, window, now);
            if events.len() >= MOST_EVENTS {
                events.pop_front();
            }
            events.push_back(now);
            events.len()
        })
    }

    /// How many events there were of this address within the window, and the last one's time.
    pub(crate) fn count(&self, who: IpAddr, now: Instant) -> (usize, Option<Instant>) {
        self.with(now, |counted, window| {
            let name = counted.name(who);
            let Some(events) = counted.events.get_mut(&name) else { return (0, None) };
            recent(events, window, now);
            (events.len(), events.back().copied())
        })
    }

    /// Forgets an address.
    pub(crate) fn forget(&self, who: IpAddr, now: Instant) {
        self.with(now, |counted, _| {
            let name = counted.name(who);
            counted.events.remove(&name);
        });
    }

    fn with<T>(&self, now: Instant, work: impl FnOnce(&mut Counted, Duration) -> T) -> T {
        let mut counted = self.counted.lock().unwrap_or_else(PoisonError::into_inner);
        if counted.as_ref().is_some_and(|counted| now.saturating_duration_since(counted.since) >= DAY) {
            *counted = None;
        }
        work(counted.get_or_insert_with(|| Counted::new(now)), self.window)
    }
}

impl Counted {
    fn new(now: Instant) -> Counted {
        let (a, b) = (uuid::Uuid::new_v4(), uuid::Uuid::new_v4());
        let mut key = [0; 64];
        key[..16].copy_from_slice(a.as_bytes());
        key[16..32].copy_from_slice(b.as_bytes());
        Counted { key, since: now, events: HashMap::new() }
    }

    /// An address's network under today's key.
    fn name(&self, who: IpAddr) -> [u8; 32] {
        let mut mac = Hmac::<Sha256>::new(&self.key.into());
        match network(who) {
            IpAddr::V4(address) => mac.update(&address.octets()),
            IpAddr::V6(address) => mac.update(&address.octets()),
        }
        mac.finalize().into_bytes().into()
    }

    fn make_room(&mut self, window: Duration, now: Instant) {
        self.events.retain(|_, events| {
            recent(events, window, now);
            !events.is_empty()
        });
        if self.events.len() >= MOST_ADDRESSES {
            let stalest = self.events.iter().min_by_key(|(_, events)| events.back().copied());
            if let Some(name) = stalest.map(|(name, _)| *name) {
                self.events.remove(&name);
            }
        }
    }
}

fn recent(events: &mut VecDeque<Instant>, window: Duration, now: Instant) {
    while events.front().is_some_and(|time| now.saturating_duration_since(*time) >= window) {
        events.pop_front();
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use std::net::Ipv4Addr;

    fn client(peer: &str, lines: &[&str], trusted: &[&str]) -> String {
        let trusted = TrustedProxies::parse(trusted.iter().copied()).unwrap();
        let mut headers = HeaderMap::new();
        for line in lines {
            headers.append("x-forwarded-for", line.parse().unwrap());
        }
        client_address(peer.parse().unwrap(), &headers, &trusted).to_string()
    }

    #[test]
    fn only_a_trusted_proxy_is_believed() {
        assert_eq!(client("198.51.100.7", &["203.0.113.9"], &[]), "198.51.100.7");
        assert_eq!(client("198.51.100.7", &["203.0.113.9"], &["10.0.0.0/8"]), "198.51.100.7");
        assert_eq!(client("10.1.2.3", &["203.0.113.9"], &["10.0.0.0/8"]), "203.0.113.9");
        assert_eq!(client("10.1.2.3", &["6.6.6.6, 203.0.113.9"], &["10.0.0.0/8"]), "203.0.113.9");
        assert_eq!(client("10.1.2.3", &["6.6.6.6", "203.0.113.9, 10.9.9.9"], &["10.0.0.0/8"]), "203.0.113.9");
        assert_eq!(client("10.1.2.3", &["6.6.6.6, rubbish"], &["10.0.0.0/8"]), "10.1.2.3");
        assert_eq!(client("10.1.2.3", &[], &["10.0.0.0/8"]), "10.1.2.3");
        assert_eq!(client("::ffff:10.1.2.3", &["203.0.113.9:4711"], &["10.0.0.0/8"]), "203.0.113.9");
        assert_eq!(client("fd00::1", &["[2001:db8::5]:443"], &["fd00::/8"]), "2001:db8::5");
        assert_eq!(client("fd00::1", &["[2001:db8::5]"], &["fd00::1"]), "2001:db8::5");
    }

    #[test]
    fn events_are_counted_within_the_window_by_address() {
        let (tally, now) = (Tally::new(Duration::from_secs(60)), Instant::now());
        let address = |text: &str| text.parse::<IpAddr>().unwrap();
        let (a, b) = (address("192.0.2.1"), address("192.0.2.2"));
        assert_eq!((tally.note(a, now), tally.note(a, now), tally.note(b, now)), (1, 2, 1));
        assert_eq!(tally.note(address("::ffff:192.0.2.1"), now), 3, "the same address written otherwise");
        assert_eq!(tally.count(a, now + Duration::from_secs(59)), (3, Some(now)));
        assert_eq!(tally.count(a, now + Duration::from_secs(60)), (0, None));
        assert_eq!(
            (tally.note(address("2001:db8::1"), now), tally.note(address("2001:db8::2"), now)),
            (1, 2)
        );
        assert_eq!(tally.note(address("2001:db8:0:1::1"), now), 1, "another network");
        tally.forget(b, now);
        assert_eq!(tally.count(b, now), (0, None));
    }

    #[test]
    fn the_key_is_renewed_daily_and_memory_is_bounded() {
        let (tally, now) = (Tally::new(DAY), Instant::now());
        let a = IpAddr::V4(Ipv4Addr::LOCALHOST);
        let name = || tally.counted.lock().unwrap().as_ref().unwrap().name(a);
        tally.note(a, now);
        let first = name();
        assert_eq!(tally.count(a, now + DAY), (0, None));
        assert_ne!(first, name(), "under another key");
        let later = now + DAY;
        for _ in 0..2 * MOST_EVENTS {
            tally.note(a, later);
        }
        assert_eq!(tally.count(a, later).0, MOST_EVENTS);
        for i in 0..MOST_ADDRESSES as u32 + 5 {
            tally.note(Ipv4Addr::from(i + (1 << 24)).into(), later + Duration::from_millis(u64::from(i)));
        }
        assert_eq!(tally.counted.lock().unwrap().as_ref().unwrap().events.len(), MOST_ADDRESSES);
    }
}
