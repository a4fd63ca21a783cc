//! What researchers read.

use crate::app::{App, Stimuli};
use crate::error::ApiError;
use crate::export::{codebook_csv, responses_csv};
use crate::extract::{Parameters, Researcher};
use crate::results::{pairs_csv, report_of, results_of};
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Duration;

pub(crate) async fn get_studies(_: Researcher, State(app): State<Arc<App>>) -> Result<Response, ApiError> {
    let mut studies = Vec::new();
    for (id, loaded) in &app.studies {
        let idle = Duration::from_secs(60 * u64::from(loaded.study.idle_minutes));
        let participants = app.store.participants(id, &loaded.config_hash, idle).await?;
        let (status, detail) = match loaded.stimuli() {
            Stimuli::Ready(_) => ("ready", Value::Null),
            Stimuli::Failed(reason) => ("failed", Value::String(reason)),
            Stimuli::Preparing(making) => {
                let progress =
                    making.map(|m| json!({ "done": m.done, "total": m.total, "stimulus": m.stimulus }));
                ("preparing", progress.unwrap_or(Value::Null))
            }
        };
        studies.push(json!({
            "id": id,
            "title": loaded.study.title,
            "config_hash": loaded.config_hash,
            "status": status,
            "detail": detail,
            "trials": loaded.study.trial_count(),
            "participants": participants,
        }));
    }
    Ok(super::fresh(StatusCode::OK, json!({ "studies": studies })))
}

pub(crate) async fn get_results(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let loaded = app.study(&study)?;
    let answers = loaded.answers(&app.store).await?;
    Ok(super::fresh(StatusCode::OK, results_of(&app.store, &loaded.study, &answers).await?))
}

/// The full report. It resamples participants, which keeps a core busy: one at a time.
pub(crate) async fn get_report(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    app.study(&study)?;
    let permit = app.reporting.acquire().await.map_err(ApiError::internal)?;
    let task = app.clone();
    // On a thread of its own kind: answering participants must not wait for it.
    let judged = tokio::task::spawn_blocking(move || {
        tokio::runtime::Handle::current().block_on(async {
            let loaded = task.study(&study)?;
            let answers = loaded.answers(&task.store).await?.clone();
            report_of(&task.store, &loaded.study, &answers).await.map_err(ApiError::from)
        })
    });
    let report = judged.await.map_err(ApiError::internal)??;
    drop(permit);
    Ok(super::fresh(StatusCode::OK, report))
}

/// The paper's own three tests, computed again, to lay beside a replication's results.
pub(crate) async fn get_paper(_: Researcher) -> Result<Response, ApiError> {
    let paper = kelir_stats::paper::taylor_cameron().map_err(ApiError::internal)?;
    Ok(super::fresh(StatusCode::OK, paper))
}

pub(crate) async fn get_pairs_csv(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let loaded = app.study(&study)?;
    Ok(csv(&format!("{study}-pairs.csv"), pairs_csv(&app.store, &loaded.study).await?))
}

pub(crate) async fn get_responses_csv(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let loaded = app.study(&study)?;
    Ok(csv(&format!("{study}-responses.csv"), responses_csv(&app.store, &loaded.study).await?))
}

pub(crate) async fn get_codebook_csv(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    app.study(&study)?;
    Ok(csv(&format!("{study}-codebook.csv"), codebook_csv()))
}

fn csv(name: &str, text: String) -> Response {
    let disposition = format!("attachment; filename=\"{name}\"");
    let headers = [
        (header::CONTENT_TYPE, "text/csv; charset=utf-8".to_owned()),
        (header::CONTENT_DISPOSITION, disposition),
        (header::CACHE_CONTROL, "no-store".to_owned()),
    ];
    (headers, text).into_response()
}
