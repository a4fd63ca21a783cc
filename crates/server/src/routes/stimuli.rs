//! Stimuli, immutable: to sessions under addresses of their own, to researchers by hash.

use crate::api::{Problem, ProblemCode, refusals};
use crate::app::App;
use crate::content;
use crate::extract::{Parameters, Researcher};
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use kelir_store::PACKED;
use serde::Deserialize;
use std::sync::Arc;
use utoipa::{IntoParams, ToSchema};

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct SessionStimulusPath {
    /// The session's id.
    session: String,
    /// What the session was told as the end of the address.
    address: String,
}

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct StimulusPath {
    /// SHA-256 of its bytes, 64 hex digits.
    sha256: String,
}

/// A file's bytes.
// A `Vec<u8>` would be documented as a list of numbers.
#[derive(ToSchema)]
#[schema(value_type = String, format = Binary)]
#[expect(dead_code, reason = "only the document speaks of it")]
struct Bytes(Vec<u8>);

refusals!(NoStimulus: NotFound, NotReady);

/// The bytes of a stimulus as a session gets them; they never change. The address is the permission.
///
/// They are a line of JSON and then pictures, one after another. The line says `format` (2), `width`, `height`, `fps` (0 for a still), `loop`,
/// `frames` (which picture each frame shows), `picture_type` and `picture_bytes` (the length of each picture). A picture after the first is
/// a step from the one before it and twice as high: its upper half is added, its lower half then taken away. What follows the last picture means nothing.
#[utoipa::path(
    get, path = "/api/v1/sessions/{session}/stimuli/{address}", tag = "participants", params(SessionStimulusPath),
    responses(
        (status = OK, description = "The bytes.", content((inline(Bytes) = "application/vnd.kelir.stimulus"))),
        (status = PARTIAL_CONTENT, description = "The bytes that `Range` asks for.", content((inline(Bytes) = "application/vnd.kelir.stimulus"))),
        (status = NOT_MODIFIED, description = "`If-None-Match` names them: the browser has them already."),
        (status = RANGE_NOT_SATISFIABLE, description = "`Range` asks for bytes beyond the last."),
        NoStimulus,
    )
)]
pub(crate) async fn get_session_stimulus(
    State(app): State<Arc<App>>,
    Parameters(SessionStimulusPath { session, address }): Parameters<SessionStimulusPath>,
    headers: HeaderMap,
) -> Result<Response, Box<Problem>> {
    let found = app.presenter.find(&app.store, &session, &address).await?;
    let presented = found.ok_or_else(|| Problem::not_found("stimulus"))?;
    let etag = format!("\"{address}\"");
    if let Some(unchanged) = content::unchanged(&headers, &etag) {
        return Ok(unchanged);
    }
    let parts = app.presenter.bytes(&app.store, &presented).await.map_err(|_| damaged(&app))?;
    Ok(content::answer(&headers, &etag, PACKED, parts))
}

/// What is told of bytes that are gone or damaged, whose reason the log has; they are looked at soon.
fn damaged(app: &App) -> Box<Problem> {
    app.integrity.ask();
    let detail = "This picture is damaged and is being made again. Please try again in a minute.";
    Problem::new(ProblemCode::NotReady, detail).retry_after(30)
}

refusals!(Stimulus: NotFound, NotReady, Unauthorized);

/// The bytes of a stored stimulus, or of one frame of an animation, for researchers; they never change.
///
/// An animation is JSON (`application/vnd.kelir.animation+json`) that names its frames by hash.
#[utoipa::path(
    get, path = "/stimuli/{sha256}", tag = "studies", params(StimulusPath), security(("researcher" = [])),
    responses(
        (status = OK, description = "The bytes.", content(
            (inline(Bytes) = "image/png"), (inline(Bytes) = "image/jpeg"), (serde_json::Value = "application/vnd.kelir.animation+json")
        )),
        (status = PARTIAL_CONTENT, description = "The bytes that `Range` asks for."),
        (status = NOT_MODIFIED, description = "`If-None-Match` names them: the browser has them already."),
        (status = RANGE_NOT_SATISFIABLE, description = "`Range` asks for bytes beyond the last."),
        Stimulus,
    )
)]
pub(crate) async fn get_stimulus(
    State(app): State<Arc<App>>,
    researcher: Result<Researcher, Box<Problem>>,
    Parameters(StimulusPath { sha256 }): Parameters<StimulusPath>,
    headers: HeaderMap,
) -> Result<Response, Box<Problem>> {
    let missing = || Problem::not_found("stimulus");
    let known = app.store.stimulus_access(&sha256).await?;
    // What was told to pages before sessions had addresses of their own stays open to them for a while.
    if !known.as_ref().is_some_and(|(_, open)| *open) {
        researcher?;
    }
    let (media_type, _) = known.ok_or_else(missing)?;
    let etag = format!("\"{sha256}\"");
    if let Some(unchanged) = content::unchanged(&headers, &etag) {
        return Ok(unchanged);
    }
    let bytes =
        app.presenter.stored(&app.store, &sha256).await.ok().flatten().ok_or_else(|| damaged(&app))?;
    Ok(content::answer(&headers, &etag, &media_type, vec![bytes]))
}
