#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;

fn asked(pairs: &[(header::HeaderName, &str)]) -> HeaderMap {
    pairs.iter().map(|(name, value)| (name.clone(), value.parse().unwrap())).collect()
}

#[test]
fn one_range_is_cut_out_and_what_cannot_be_given_is_said() {
    for (range, expected) in [
        ("bytes=0-3", Wanted::Part(0..4)),
        ("bytes=2-", Wanted::Part(2..10)),
        ("bytes=-3", Wanted::Part(7..10)),
        ("bytes=-30", Wanted::Part(0..10)),
        ("bytes=4-400", Wanted::Part(4..10)),
        ("bytes=9-9", Wanted::Part(9..10)),
        ("bytes=10-", Wanted::Nothing),
        ("bytes=10-18446744073709551615", Wanted::Nothing),
        ("bytes=-0", Wanted::Nothing),
        ("bytes=3-2", Wanted::All),
        ("bytes=0-1,4-5", Wanted::All),
        ("bytes=-", Wanted::All),
        ("lines=0-1", Wanted::All),
        ("bytes=a-b", Wanted::All),
    ] {
        assert_eq!(wanted(&asked(&[(header::RANGE, range)]), "\"x\"", 10), expected, "{range}");
    }
    let other = asked(&[(header::RANGE, "bytes=2-"), (header::IF_RANGE, "\"y\"")]);
    assert_eq!(wanted(&other, "\"x\"", 10), Wanted::All);
    assert_eq!(wanted(&other, "\"y\"", 10), Wanted::Part(2..10));
}

#[test]
fn parts_are_cut_where_the_range_says() {
    let parts = || vec![Bytes::from_static(b"abc"), Bytes::new(), Bytes::from_static(b"defgh")];
    let text: Vec<u8> = b"abcdefgh".to_vec();
    for from in 0..=8 {
        for to in from..=8 {
            let got: Vec<u8> = cut(parts(), from..to).into_iter().flatten().collect();
            assert_eq!(got, text[from..to]);
        }
    }
}

#[test]
fn the_cache_holds_no_more_than_it_may_and_drops_what_was_asked_for_longest_ago() {
    let mut cache = ByteCache::new(10);
    cache.put("a".into(), Bytes::from_static(b"aaaa"));
    cache.put("b".into(), Bytes::from_static(b"bbbb"));
    assert!(cache.get("a").is_some());
    cache.put("c".into(), Bytes::from_static(b"cccc"));
    assert!(cache.get("b").is_none() && cache.get("a").is_some() && cache.get("c").is_some());
    cache.put("big".into(), Bytes::from_static(b"ddddddddddd"));
    assert!(cache.get("big").is_none() && cache.get("a").is_some());
    assert_eq!(cache.held, 8);
}
