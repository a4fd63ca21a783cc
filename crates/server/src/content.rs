//! Bytes that never change, for whoever asks for all of them, for a part, or whether they are still the same.

use axum::body::{Body, Bytes};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use http_body::{Frame, SizeHint};
use std::collections::{HashMap, VecDeque};
use std::convert::Infallible;
use std::ops::Range;
use std::pin::Pin;
use std::task::{Context, Poll};

/// How those may be kept who have them: browsers, not caches between.
const KEPT: &str = "private, max-age=31536000, immutable";

/// The answer to who has them already; it needs no bytes.
pub(crate) fn unchanged(headers: &HeaderMap, etag: &str) -> Option<Response> {
    let known = headers.get(header::IF_NONE_MATCH)?.to_str().ok()?;
    let same = known
        .split(',')
        .any(|tag| matches!(tag.trim().trim_start_matches("W/"), tag if tag == etag || tag == "*"));
    same.then(|| (StatusCode::NOT_MODIFIED, kept(etag)).into_response())
}

/// The answer with `parts` one after another, or with the one range of them that is asked for (RFC 9110, 14).
pub(crate) fn answer(headers: &HeaderMap, etag: &str, media_type: &str, parts: Vec<Bytes>) -> Response {
    let length: usize = parts.iter().map(Bytes::len).sum();
    let (status, range) = match wanted(headers, etag, length) {
        Wanted::All => (StatusCode::OK, 0..length),
        Wanted::Part(range) => (StatusCode::PARTIAL_CONTENT, range),
        Wanted::Nothing => (StatusCode::RANGE_NOT_SATISFIABLE, 0..0),
    };
    let said = match status {
        StatusCode::PARTIAL_CONTENT => Some(format!("bytes {}-{}/{length}", range.start, range.end - 1)),
        StatusCode::RANGE_NOT_SATISFIABLE => Some(format!("bytes */{length}")),
        _ => None,
    };
    let mut response = (status, kept(etag), Body::new(Parts(cut(parts, range)))).into_response();
    let mut add = |name, text: &str| {
        if let Ok(value) = HeaderValue::from_str(text) {
            response.headers_mut().insert(name, value);
        }
    };
    add(header::CONTENT_TYPE, media_type);
    add(header::ACCEPT_RANGES, "bytes");
    if let Some(said) = said {
        add(header::CONTENT_RANGE, &said);
    }
    response
}

fn kept(etag: &str) -> [(header::HeaderName, String); 2] {
    [(header::ETAG, etag.to_owned()), (header::CACHE_CONTROL, KEPT.to_owned())]
}

#[derive(Debug, PartialEq, Eq)]
enum Wanted {
    All,
    Part(Range<usize>),
    Nothing,
}

/// What `Range` asks for; several ranges, other units and what cannot be read are passed over, as the standard allows.
fn wanted(headers: &HeaderMap, etag: &str, length: usize) -> Wanted {
    let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
    if text(header::IF_RANGE).is_some_and(|tag| tag != etag) {
        return Wanted::All;
    }
    let Some(range) = text(header::RANGE).and_then(|range| range.strip_prefix("bytes=")) else {
        return Wanted::All;
    };
    let Some((first, last)) = range.split_once('-') else { return Wanted::All };
    let range = match (first.parse::<usize>(), last.parse::<usize>()) {
        (Ok(first), Ok(last)) if first <= last => first..last.saturating_add(1).min(length),
        (Ok(first), Err(_)) if last.is_empty() => first..length,
        (Err(_), Ok(last)) if first.is_empty() => length.saturating_sub(last)..length,
        _ => return Wanted::All,
    };
    if range.is_empty() { Wanted::Nothing } else { Wanted::Part(range) }
}

/// The range of the parts' bytes, uncopied.
fn cut(parts: Vec<Bytes>, range: Range<usize>) -> VecDeque<Bytes> {
    let mut at = 0;
    let mut within = VecDeque::new();
    for part in parts {
        let (from, to) = (range.start.max(at), range.end.min(at + part.len()));
        if from < to {
            within.push_back(part.slice(from - at..to - at));
        }
        at += part.len();
    }
    within
}

/// A body in parts whose length is known.
struct Parts(VecDeque<Bytes>);

impl http_body::Body for Parts {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        _: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        Poll::Ready(self.0.pop_front().map(|part| Ok(Frame::data(part))))
    }

    fn is_end_stream(&self) -> bool {
        self.0.is_empty()
    }

    fn size_hint(&self) -> SizeHint {
        SizeHint::with_exact(self.0.iter().map(|part| part.len() as u64).sum())
    }
}

/// Bytes that were asked for lately, up to a number of them in all.
#[derive(Debug)]
pub(crate) struct ByteCache {
    most: usize,
    held: usize,
    asked: u64,
    /// With the count of questions when it was last asked for.
    entries: HashMap<String, (Bytes, u64)>,
}

impl ByteCache {
    pub(crate) fn new(most: usize) -> ByteCache {
        ByteCache { most, held: 0, asked: 0, entries: HashMap::new() }
    }

    pub(crate) fn get(&mut self, name: &str) -> Option<Bytes> {
        self.asked += 1;
        let (bytes, last) = self.entries.get_mut(name)?;
        *last = self.asked;
        Some(bytes.clone())
    }

    /// Keeps them, and lets go of what has not been asked for longest.
    pub(crate) fn put(&mut self, name: String, bytes: Bytes) {
        if bytes.len() > self.most || self.entries.contains_key(&name) {
            return;
        }
        self.held += bytes.len();
        self.entries.insert(name, (bytes, self.asked));
        while self.held > self.most {
            let Some(oldest) = self.entries.iter().min_by_key(|(_, (_, last))| *last) else { return };
            let oldest = oldest.0.clone();
            self.held -= self.entries.remove(&oldest).map_or(0, |(bytes, _)| bytes.len());
        }
    }
}

#[cfg(test)]
mod tests;
