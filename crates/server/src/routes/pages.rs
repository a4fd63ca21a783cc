//! The two pages and what they load.

use crate::api::Problem;
use crate::app::App;
use crate::extract::Parameters;
use crate::web;
use axum::extract::State;
use axum::http::{StatusCode, Uri, header};
use axum::response::{IntoResponse, Redirect, Response};
use std::sync::Arc;

/// There is no front page: the one study, with the link's parameters, or the console.
pub(crate) async fn get_root(State(app): State<Arc<App>>, uri: Uri) -> Redirect {
    let mut studies = app.studies.keys();
    match (studies.next(), studies.next()) {
        (Some(only), None) => Redirect::temporary(&format!("/study/{only}{}", query(&uri))),
        _ => Redirect::temporary("/console"),
    }
}

/// The participant's page; for an unknown study it is still the page, which says so.
pub(crate) async fn get_participant(
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, Box<Problem>> {
    let known = app.studies.contains_key(&study) || app.broken.contains_key(&study);
    let status = if known { StatusCode::OK } else { StatusCode::NOT_FOUND };
    page(status, web::PARTICIPANT)
}

/// The same address without its last slash, the parameters kept: a panel's are in them.
pub(crate) async fn without_slash(uri: Uri) -> Redirect {
    Redirect::permanent(&format!("{}{}", uri.path().trim_end_matches('/'), query(&uri)))
}

fn query(uri: &Uri) -> String {
    uri.query().map(|query| format!("?{query}")).unwrap_or_default()
}

/// The researcher's page, at any of its addresses.
pub(crate) async fn get_console() -> Result<Response, Box<Problem>> {
    page(StatusCode::OK, web::CONSOLE)
}

/// A file of the bundle; its name has its hash in it, so it never changes.
pub(crate) async fn get_asset(Parameters(path): Parameters<String>) -> Result<Response, Box<Problem>> {
    let bytes = web::file(&format!("assets/{path}")).ok_or_else(|| Problem::not_found("file"))?;
    let media_type = match path.rsplit('.').next() {
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("svg") => "image/svg+xml",
        Some("txt") => "text/plain; charset=utf-8",
        Some("woff2") => "font/woff2",
        _ => "application/octet-stream",
    };
    let keep = if path.ends_with(".txt") { "no-cache" } else { "public, max-age=31536000, immutable" };
    Ok(([(header::CONTENT_TYPE, media_type), (header::CACHE_CONTROL, keep)], bytes).into_response())
}

fn page(status: StatusCode, name: &str) -> Result<Response, Box<Problem>> {
    let bytes = web::file(name).ok_or_else(|| Problem::not_found("page"))?;
    let headers = [(header::CONTENT_TYPE, "text/html; charset=utf-8"), (header::CACHE_CONTROL, "no-cache")];
    Ok((status, headers, bytes).into_response())
}
