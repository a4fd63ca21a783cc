//! Whether the server is up.

use crate::api::{Problem, refusals};
use crate::app::App;
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

refusals!(Health:);

/// Whether the server answers and can store: something is written, synced and taken away again.
#[utoipa::path(get, path = "/healthz", tag = "about", responses((status = OK, description = "`ok`", body = String), Health))]
pub(crate) async fn get_health(State(app): State<Arc<App>>) -> Result<Response, Box<Problem>> {
    app.store.check().await?;
    Ok(([(header::CACHE_CONTROL, "no-store")], "ok\n").into_response())
}
