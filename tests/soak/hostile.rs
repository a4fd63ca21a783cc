//! Words that no server likes to hear.

use super::random::Random;
use serde_json::{Map, Value, json};

/// Parts of an address, as they stand in a request's first line.
pub(super) const PARTS: &[&str] = &[
    "small",
    "x",
    "..",
    ".",
    "%2e%2e%2f",
    "%2e%2e%2fetc%2fpasswd",
    "%00",
    "%ff",
    "%",
    "%zz",
    "%u0041",
    "🪆",
    "%F0%9F%AA%86",
    "0",
    "-1",
    "1e9",
    "4",
    "99999999999999999999",
    "null",
    "current",
    "00000000",
    "%3Cscript%3E",
    "%27%3B%20drop%20table%20answers%3B--",
    "%0d%0aSet-Cookie:%20x=1",
    "preview-x",
    "%E2%80%AEabc",
    "",
    "style.css",
    "index.html",
];

/// What may follow an address.
pub(super) const QUERIES: &[&str] = &[
    "",
    "",
    "",
    "?a=%00",
    "/",
    "?limit=0&cursor=zz",
    "?with=nonsense",
    "?known=-1",
    "?known=99999999999999999999",
    "?known=0&known=1",
    "?preview",
    "?kind=pilot&exp=9&sig=x",
    "?%zz",
    "?include=pilot",
    "?=",
    "?%F0%9F%AA%86=%ff",
    "?limit=1e3&format=..",
];

/// All of them but CONNECT, and one that there is not.
pub(super) const METHODS: &[&str] = &[
    "GET", "GET", "GET", "POST", "POST", "PUT", "PUT", "HEAD", "OPTIONS", "DELETE", "PATCH", "TRACE", "BREW",
];

/// Bodies that are to be taken as they are.
const BODIES: &[&[u8]] = &[
    b"",
    b"{}",
    b"[]",
    b"null",
    b"1e400",
    b"{\"display\":{\"a\":1e400}}",
    b"{\"display\":{\"a\":123456789012345678901234567890}}",
    b"{\"display\":{\"a\":\"\xff\xfe\"}}",
    b"{\"display\":{\"a\":\"\\ud800\"}}",
    b"{\"params\":{\"PROLIFIC_PID\":\"a\\u0000b\"}}",
    b"{\"display\":{\"\\u0000\":\"\\u202e\"}}",
    b"{\"params\":{\"a\":\"1\",\"a\":\"2\"}}",
    b"\xef\xbb\xbf{}",
    b"{\"choice\":\"left\",\"rt\":-0.0}",
    b"{\"choice\":\"left\",\"rt\":1e308,\"events\":[[]]}",
    b"{\"params\":{\"__proto__\":\"x\",\"constructor\":\"y\"}}",
    b"a=b",
    b"{\"choice\":\"left\"",
    b"{\"password\":\"\"}",
    b"{\"kind\":\"simulated\"}",
    b"{\"params\":{\"preview\":\"\"}}",
];

const KEYS: &[&str] = &[
    "choice",
    "rt",
    "onset",
    "viewport",
    "input",
    "scale",
    "timestamp",
    "trial_type",
    "params",
    "display",
    "__proto__",
    "",
    "hidden_ms",
    "PROLIFIC_PID",
    "\0",
    "events",
    "frames",
    "language",
    "kind",
    "confidence",
    "geometry",
    "device_pixel_ratio",
];

/// A body of any shape.
pub(super) fn body(random: &mut Random) -> Vec<u8> {
    match random.below(6) {
        0 | 1 => random.pick(BODIES).to_vec(),
        2 => {
            let depth = *random.pick(&[5, 127, 128, 200, 30_000]);
            [b"{\"display\":{\"a\":".to_vec(), vec![b'['; depth], vec![b']'; depth], b"}}".to_vec()].concat()
        }
        3 => (0..200).map(|_| random.below(256) as u8).collect(),
        4 => {
            let mut answer =
                json!({ "choice": *random.pick(&["left", "right", "x"]), "rt": value(random, 0) });
            answer[*random.pick(KEYS)] = value(random, 0);
            answer.to_string().into_bytes()
        }
        _ => object(random, 0).to_string().into_bytes(),
    }
}

fn object(random: &mut Random, depth: usize) -> Value {
    let fields = *random.pick(&[0, 1, 3, 5]);
    Value::Object(
        (0..fields)
            .map(|_| ((*random.pick(KEYS)).to_owned(), value(random, depth + 1)))
            .collect::<Map<_, _>>(),
    )
}

fn value(random: &mut Random, depth: usize) -> Value {
    match random.below(if depth > 3 { 4 } else { 6 }) {
        0 => Value::Null,
        1 => random.chance(50).into(),
        2 => (*random.pick(&[0.0, -0.0, -1.0, 1e308, 5e-324, 9_007_199_254_740_992.0, 1.5, -1e-9])).into(),
        3 => {
            let long = "𝕏".repeat(*random.pick(&[1, 50, 2000]));
            let words =
                ["", "left", "mouse", "=1+1", "\0", "\u{202e}", "'\"<img src=x>", "\r\nX: y", "＝1", &long];
            (*random.pick(&words)).into()
        }
        4 => {
            let length = *random.pick(&[0, 1, 2, 50]);
            (0..length).map(|_| value(random, depth + 1)).collect::<Vec<_>>().into()
        }
        _ => object(random, depth),
    }
}

/// Headers, besides those that let somebody in.
pub(super) fn headers(random: &mut Random) -> Vec<(&'static str, &'static str)> {
    let mut headers = Vec::new();
    let types = [
        "application/json",
        "application/json",
        "application/json",
        "application/json; charset=utf-16",
        "text/plain",
        "multipart/form-data",
        "",
    ];
    headers.push(("Content-Type", *random.pick(&types)));
    if random.chance(20) {
        headers.push((
            "Range",
            *random.pick(&[
                "bytes=0-",
                "bytes=-1",
                "bytes=9-1",
                "bytes=0-0,2-3",
                "bytes=99999999999999999999-",
                "x",
            ]),
        ));
        headers.push(("If-None-Match", *random.pick(&["*", "\"x\"", ""])));
        headers.push(("If-Range", *random.pick(&["\"x\"", "yesterday"])));
        headers.push(("Accept-Encoding", *random.pick(&["gzip", "br;q=9", "*", "x", "identity;q=0"])));
    }
    if random.chance(20) {
        headers.push(("Idempotency-Key", *random.pick(&["k", "", "\u{e4}", "one two"])));
        headers.push(("Accept", *random.pick(&["text/html", "*/*", "application/json", "x"])));
        headers.push(("Origin", *random.pick(&["null", "http://evil.example", "x"])));
        headers.push(("Sec-Fetch-Site", *random.pick(&["cross-site", "same-origin", "x"])));
        headers.push(("X-Forwarded-For", *random.pick(&["1.2.3.4", "x", "::1, ,", "a, b, c"])));
    }
    headers
}
