//! What is answered while the data folder is being opened: that it is.

use crate::api::{Problem, ProblemCode};
use crate::headers;
use axum::{Router, middleware};

/// 503 everywhere, `/healthz` too, with a time to come back.
pub(crate) fn router() -> Router {
    Router::new()
        .fallback(starting)
        .layer(middleware::from_fn(headers::for_people))
        .layer(middleware::from_fn(headers::secure))
}

async fn starting() -> Box<Problem> {
    let detail = "The server is starting. Please come back in a few seconds.";
    Problem::new(ProblemCode::NotReady, detail).retry_after(2)
}
