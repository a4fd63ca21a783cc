//! What anybody may know of a study.

use crate::app::App;
use crate::error::ApiError;
use crate::extract::Parameters;
use axum::extract::State;
use axum::http::StatusCode;
use axum::response::Response;
use serde_json::json;
use std::sync::Arc;

pub(crate) async fn get_study(
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let loaded = app.study(&study)?;
    loaded.ready()?;
    let study = &loaded.study;
    let body = json!({
        "id": study.id,
        "title": study.title,
        "question": study.question,
        "surround": study.surround,
        "size": study.size,
        "texts": study.texts,
        "estimated_minutes": study.estimated_minutes,
    });
    Ok(super::fresh(StatusCode::OK, body))
}
