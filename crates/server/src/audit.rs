//! What the log says of requests and of who did what: no address of a person, no secret, nobody's id, no query.

use axum::extract::MatchedPath;
use axum::http::{Method, StatusCode};
use std::time::Instant;

/// The log's target for sign-ins, files taken, studies opened and closed; `KELIR_LOG=kelir::audit=info` shows nothing else.
pub(crate) const AUDIT: &str = "kelir::audit";
/// The log's target for requests.
const ACCESS: &str = "kelir::access";

/// A request that is being answered, for the log once it is.
pub(crate) struct Access {
    pub(crate) method: Method,
    /// The route, its variable parts unnamed; none where there is no such address.
    pub(crate) route: Option<MatchedPath>,
    pub(crate) status: StatusCode,
    pub(crate) begun: Instant,
    /// Bytes of the body that were handed over, packed as they were.
    pub(crate) bytes: usize,
}

impl Access {
    pub(crate) fn log(&self) {
        let (method, status, bytes) = (&self.method, self.status.as_u16(), self.bytes);
        let route = self.route.as_ref().map_or("none", MatchedPath::as_str);
        let ms = self.begun.elapsed().as_secs_f64() * 1000.0;
        tracing::info!(target: ACCESS, %method, route, status, ms = (ms * 10.0).round() / 10.0, bytes);
    }
}
