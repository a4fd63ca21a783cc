//! Whether the server is up, and whether what it stores is whole.

use super::{Answered, Fresh};
use crate::api::{IntegrityReport, Problem, refusals};
use crate::app::App;
use crate::extract::Researcher;
use axum::extract::State;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use std::sync::Arc;

refusals!(Health:);

/// Whether the server answers and can store: something is written, synced and taken away again.
///
/// `degraded` means that something stored is damaged and people can take part all the same; researchers are told what.
#[utoipa::path(
    get, path = "/healthz", tag = "about",
    responses((status = OK, description = "`ok` or `degraded`", body = String), Health)
)]
pub(crate) async fn get_health(State(app): State<Arc<App>>) -> Result<Response, Box<Problem>> {
    app.store.check().await?;
    let word = if app.integrity.faults().is_empty() { "ok\n" } else { "degraded\n" };
    Ok(([(header::CACHE_CONTROL, "no-store")], word).into_response())
}

refusals!(Integrity: Unauthorized);

/// What is damaged of all that is stored, as of the last look.
#[utoipa::path(
    get, path = "/api/v1/integrity", tag = "about", security(("researcher" = [])),
    responses((status = OK, description = "What was found.", body = IntegrityReport), Integrity)
)]
pub(crate) async fn get_integrity(_: Researcher, State(app): State<Arc<App>>) -> Answered<IntegrityReport> {
    Ok(Fresh(IntegrityReport { faults: app.integrity.faults() }))
}
