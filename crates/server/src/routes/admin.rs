//! What researchers read.

use crate::app::{App, Stimuli};
use crate::error::ApiError;
use crate::export::{codebook_csv, responses_csv};
use crate::extract::{Parameters, Researcher};
use crate::results::{pairs_csv, report_of, results_of};
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use kelir_report::{Document, Figures, StudyReport, html, markdown};
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

/// The full report as JSON.
pub(crate) async fn get_report(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    Ok(super::fresh(StatusCode::OK, judged(&app, study).await?))
}

/// The full report as one HTML file.
pub(crate) async fn get_report_html(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let name = format!("{study}-report.html");
    let document = Document::of(&judged(&app, study).await?);
    Ok(download("text/html; charset=utf-8", &name, html(&document)))
}

/// The full report as one Markdown file, its figures within.
pub(crate) async fn get_report_md(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(study): Parameters<String>,
) -> Result<Response, ApiError> {
    let name = format!("{study}-report.md");
    let document = Document::of(&judged(&app, study).await?);
    Ok(download("text/markdown; charset=utf-8", &name, markdown(&document, &Figures::Embedded).text))
}

/// The full report of a study. It resamples participants, which keeps a core busy: one at a time.
async fn judged(app: &Arc<App>, study: String) -> Result<StudyReport, ApiError> {
    app.study(&study)?;
    let _permit = app.reporting.acquire().await.map_err(ApiError::internal)?;
    let task = app.clone();
    // On a thread of its own kind: answering participants must not wait for it.
    let judged = tokio::task::spawn_blocking(move || {
        tokio::runtime::Handle::current().block_on(async {
            let loaded = task.study(&study)?;
            let answers = loaded.answers(&task.store).await?;
            report_of(&task.store, &loaded.study, &answers).await.map_err(ApiError::from)
        })
    });
    judged.await.map_err(ApiError::internal)?
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
    download("text/csv; charset=utf-8", name, text)
}

/// A file to keep, which no browser opens in the console's own origin.
fn download(media_type: &str, name: &str, text: String) -> Response {
    let headers = [
        (header::CONTENT_TYPE, media_type.to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
        (header::CACHE_CONTROL, "no-store".to_owned()),
    ];
    (headers, text).into_response()
}
