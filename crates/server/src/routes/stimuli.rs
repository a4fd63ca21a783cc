//! Stimuli, by hash, immutable.

use crate::app::App;
use crate::error::ApiError;
use crate::extract::Parameters;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

pub(crate) async fn get_stimulus(
    State(app): State<Arc<App>>,
    Parameters(sha256): Parameters<String>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    let missing = || ApiError::not_found("stimulus");
    let (info, bytes) = app.store.stimulus(&sha256).await?.ok_or_else(missing)?;
    let etag = format!("\"{sha256}\"");
    let known = headers.get(header::IF_NONE_MATCH).and_then(|v| v.to_str().ok());
    let known =
        known.is_some_and(|tags| tags.split(',').any(|tag| tag.trim().trim_start_matches("W/") == etag));
    let keep =
        [(header::ETAG, etag), (header::CACHE_CONTROL, "public, max-age=31536000, immutable".to_owned())];
    if known {
        return Ok((StatusCode::NOT_MODIFIED, keep).into_response());
    }
    Ok((keep, [(header::CONTENT_TYPE, info.media_type)], bytes).into_response())
}
