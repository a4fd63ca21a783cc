//! Stimuli, by hash, immutable.

use crate::api::{Problem, refusals};
use crate::app::App;
use crate::extract::Parameters;
use axum::extract::State;
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use std::sync::Arc;
use utoipa::{IntoParams, ToSchema};

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct StimulusPath {
    /// SHA-256 of its bytes, 64 hex digits.
    sha256: String,
}

refusals!(Stimulus: NotFound);

/// A file's bytes.
// A `Vec<u8>` would be documented as a list of numbers.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "only the document speaks of it")]
struct Bytes(Vec<u8>);

/// The bytes of a stimulus, or of one frame of an animation; they never change.
///
/// An animation is JSON (`application/vnd.kelir.animation+json`) that names its frames by hash.
#[utoipa::path(
    get, path = "/stimuli/{sha256}", tag = "participants", params(StimulusPath),
    responses(
        (status = OK, description = "The bytes.", content(
            (inline(Bytes) = "image/png"), (inline(Bytes) = "image/jpeg"), (serde_json::Value = "application/vnd.kelir.animation+json")
        )),
        (status = NOT_MODIFIED, description = "`If-None-Match` names them: the browser has them already."),
        Stimulus,
    )
)]
pub(crate) async fn get_stimulus(
    State(app): State<Arc<App>>,
    Parameters(StimulusPath { sha256 }): Parameters<StimulusPath>,
    headers: HeaderMap,
) -> Result<Response, Box<Problem>> {
    let missing = || Problem::not_found("stimulus");
    let (media_type, bytes) = app.store.stimulus(&sha256).await?.ok_or_else(missing)?;
    let etag = format!("\"{sha256}\"");
    let known = headers.get(header::IF_NONE_MATCH).and_then(|v| v.to_str().ok());
    let known =
        known.is_some_and(|tags| tags.split(',').any(|tag| tag.trim().trim_start_matches("W/") == etag));
    let keep =
        [(header::ETAG, etag), (header::CACHE_CONTROL, "public, max-age=31536000, immutable".to_owned())];
    if known {
        return Ok((StatusCode::NOT_MODIFIED, keep).into_response());
    }
    Ok((keep, [(header::CONTENT_TYPE, media_type)], bytes).into_response())
}
