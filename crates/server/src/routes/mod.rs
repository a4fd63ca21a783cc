//! The routes, one module a resource.

pub(crate) mod admin;
pub(crate) mod auth;
mod pages;
mod sessions;
mod stimuli;
mod studies;

use crate::app::App;
use crate::error::ApiError;
use crate::headers;
use axum::extract::{DefaultBodyLimit, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post, put};
use axum::{Router, middleware};
use std::sync::Arc;
use tower_http::compression::CompressionLayer;
use tower_http::compression::predicate::{DefaultPredicate, NotForContentType, Predicate};

/// Most bytes of a body, but for a trial's, whose frame times may be many.
const BODY_LIMIT: usize = 64 << 10;
const TRIAL_LIMIT: usize = 1 << 20;

pub(crate) fn router(app: Arc<App>) -> Router {
    // Pictures are compressed as they are; the default predicate leaves them alone, octets too.
    let compressible = DefaultPredicate::new().and(NotForContentType::const_new("application/octet-stream"));
    Router::new()
        .route("/", get(pages::get_root))
        .route("/study/{study}", get(pages::get_participant))
        .route("/console", get(pages::get_console))
        .route("/console/{*path}", get(pages::get_console))
        .route("/assets/{*path}", get(pages::get_asset))
        .route("/stimuli/{sha256}", get(stimuli::get_stimulus))
        .route("/api/v1/studies/{study}", get(studies::get_study))
        .route("/api/v1/studies/{study}/sessions", post(sessions::post_session))
        .route("/api/v1/sessions/{session}", get(sessions::get_session))
        .route("/api/v1/sessions/{session}/consent", post(sessions::post_consent))
        .route(
            "/api/v1/sessions/{session}/trials/{trial}",
            put(sessions::put_trial).layer(DefaultBodyLimit::max(TRIAL_LIMIT)),
        )
        .route("/api/v1/sessions/{session}/complete", post(sessions::post_complete))
        .route("/api/v1/login", post(auth::post_login))
        .route("/api/v1/logout", post(auth::post_logout))
        .route("/api/v1/admin/studies", get(admin::get_studies))
        .route("/api/v1/admin/studies/{study}/results", get(admin::get_results))
        .route("/api/v1/admin/studies/{study}/report", get(admin::get_report))
        .route("/api/v1/admin/studies/{study}/report.html", get(admin::get_report_html))
        .route("/api/v1/admin/studies/{study}/report.md", get(admin::get_report_md))
        .route("/api/v1/admin/studies/{study}/pairs.csv", get(admin::get_pairs_csv))
        .route("/api/v1/admin/studies/{study}/responses.csv", get(admin::get_responses_csv))
        .route("/api/v1/admin/studies/{study}/codebook.csv", get(admin::get_codebook_csv))
        .route("/api/v1/admin/papers/taylor-cameron", get(admin::get_paper))
        .route("/healthz", get(get_health))
        .fallback(not_found)
        .method_not_allowed_fallback(method_not_allowed)
        .layer(DefaultBodyLimit::max(BODY_LIMIT))
        .layer(CompressionLayer::new().compress_when(compressible))
        .layer(middleware::from_fn(headers::secure))
        .with_state(app)
}

async fn get_health(State(app): State<Arc<App>>) -> Result<Response, ApiError> {
    app.store.ping().await?;
    Ok(([(header::CACHE_CONTROL, "no-store")], "ok\n").into_response())
}

async fn not_found() -> ApiError {
    ApiError::not_found("address")
}

async fn method_not_allowed() -> ApiError {
    let message = "This address does not take that method.";
    ApiError::new(StatusCode::METHOD_NOT_ALLOWED, "method_not_allowed", message)
}

/// A JSON answer that no cache may keep.
fn fresh(status: StatusCode, body: impl serde::Serialize) -> Response {
    (status, [(header::CACHE_CONTROL, "no-store")], axum::Json(body)).into_response()
}
