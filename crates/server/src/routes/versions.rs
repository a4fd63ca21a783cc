//! What came of a version of a study: results, reports, tables.

use super::{Answered, Fresh};
use crate::api::{Codebook, Pooling, Problem, refusals, version_ref};
use crate::app::App;
use crate::audit::AUDIT;
use crate::extract::{Parameters, Query, Researcher};
use axum::body::Body;
use axum::extract::FromRequestParts;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use kelir_house::results::{StudyResults, report_of, results_of};
use kelir_house::selection::Selection;
use kelir_house::{
    codebook_csv, codebook_of, events_table, pairs_csv, participants_table, responses_csv, spreadsheet,
};
use kelir_report::{Document, Figures, StudyReport, html, markdown};
use kelir_store::background;
use kelir_study::columns::{codebook, events_codebook, participants_codebook};
use serde::Deserialize;
use std::future::Future;
use std::sync::Arc;
use tokio::runtime::Handle;
use utoipa::IntoParams;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct VersionPath {
    /// The study's id.
    study: String,
    /// The version: `current`, its hash, or the beginning of the hash, 8 digits or more.
    version: String,
}

refusals!(Chosen: Unauthorized, InvalidParameter, AmbiguousVersion, NotFound);

/// The media type of a spreadsheet.
const XLSX: &str = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet";

type File = Result<Response, Box<Problem>>;

/// What a researcher who is signed in asks for.
pub(crate) struct Asked {
    app: Arc<App>,
    study: String,
    /// The versions.
    selection: Selection,
}

impl FromRequestParts<Arc<App>> for Asked {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Asked, Box<Problem>> {
        Researcher::from_request_parts(parts, app).await?;
        let Parameters(VersionPath { study, version }) = Parameters::from_request_parts(parts, app).await?;
        let Query(pooling) = Query::<Pooling>::from_request_parts(parts, app).await?;
        let selection = app.select(&study, &version_ref(&version)?, &pooling.with()?).await?;
        let selection = selection.including(pooling.include()?);
        Ok(Asked { app: app.clone(), study, selection })
    }
}

/// The results in short: the paper's test for each block, the scale, the stimuli.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/results", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "The results.", body = StudyResults), Chosen)
)]
pub(crate) async fn get_results(asked: Asked) -> Answered<StudyResults> {
    let Asked { app, selection, .. } = asked;
    let results = behind(async move {
        let answers = app.answers(&selection).await?;
        Ok(results_of(&app.store, &selection, &answers).await?)
    });
    Ok(Fresh(results.await?))
}

/// The full report: every number there is.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/report", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "The report.", body = StudyReport), Chosen)
)]
pub(crate) async fn get_report(asked: Asked) -> Answered<StudyReport> {
    Ok(Fresh(judged(asked).await?))
}

/// The full report as it is written: sections of texts, tables and figures, the same as in the files of it.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/document", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "The document.", body = Document), Chosen)
)]
pub(crate) async fn get_document(asked: Asked) -> Answered<Document> {
    Ok(Fresh(Document::of(&judged(asked).await?)))
}

/// The full report as one HTML file.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/report.html", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/html"), Chosen)
)]
pub(crate) async fn get_report_html(asked: Asked) -> File {
    let name = format!("{}-report.html", asked.study);
    let document = Document::of(&judged(asked).await?);
    Ok(download("text/html; charset=utf-8", &name, html(&document)))
}

/// The full report as one Markdown file, its figures within.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/report.md", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/markdown"), Chosen)
)]
pub(crate) async fn get_report_md(asked: Asked) -> File {
    let name = format!("{}-report.md", asked.study);
    let document = Document::of(&judged(asked).await?);
    Ok(download("text/markdown; charset=utf-8", &name, markdown(&document, &Figures::Embedded).text))
}

/// The full report of a study. It resamples participants, which keeps a core busy: one at a time.
async fn judged(asked: Asked) -> Result<StudyReport, Box<Problem>> {
    let Asked { app, selection, .. } = asked;
    let task = app.clone();
    let _permit = app.reporting.acquire().await.map_err(Problem::internal)?;
    behind(async move {
        let answers = task.answers(&selection).await?;
        Ok(report_of(&task.store, &selection, &answers).await?)
    })
    .await
}

/// Does what reads a lot and keeps a core busy behind everybody who answers.
async fn behind<T: Send + 'static>(
    work: impl Future<Output = Result<T, Box<Problem>>> + Send + 'static,
) -> Result<T, Box<Problem>> {
    let done = background(|| Handle::current().block_on(work)).await;
    done.ok_or_else(|| Problem::internal("what was asked for did not come to an end"))?
}

/// One row a trial, all that is known of it.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/responses.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_responses_csv(asked: Asked) -> File {
    let name = format!("{}-responses.csv", asked.study);
    let table = behind(async move { Ok(responses_csv(&asked.app.store, &asked.selection).await?) });
    Ok(csv(&name, table.await?))
}

/// One row a session: who came, when, with what, how far, and whether their answers are judged. What each column is, is in
/// `participants_codebook.csv`.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/participants.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_participants_csv(asked: Asked) -> File {
    let name = format!("{}-participants.csv", asked.study);
    let table =
        behind(async move { Ok(participants_table(&asked.app.store, &asked.selection).await?.csv()) });
    Ok(csv(&name, table.await?))
}

/// What each column of `participants.csv` is, as a table.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/participants_codebook.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_participants_codebook_csv(asked: Asked) -> File {
    let table = codebook_of(&participants_codebook(&asked.selection.study.session.params));
    Ok(csv(&format!("{}-participants-codebook.csv", asked.study), table.csv()))
}

/// Every table in one spreadsheet, with a codebook: numbers are numbers whatever language the reader's spreadsheet speaks.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/export.xlsx", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = Vec<u8>, content_type = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"), Chosen)
)]
pub(crate) async fn get_export_xlsx(asked: Asked) -> File {
    let name = format!("{}.xlsx", asked.study);
    let file =
        behind(
            async move { spreadsheet(&asked.app.store, &asked.selection).await.map_err(Problem::internal) },
        );
    Ok(download(XLSX, &name, file.await?))
}

/// The choices as pwcmp reads them, one row a trial.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/pairs.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_pairs_csv(asked: Asked) -> File {
    let name = format!("{}-pairs.csv", asked.study);
    let table = behind(async move { Ok(pairs_csv(&asked.app.store, &asked.selection).await?) });
    Ok(csv(&name, table.await?))
}

/// One row for each thing that happened to a page while a trial was taken: lost focus, a resize, an input that did not count.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/events.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_events_csv(asked: Asked) -> File {
    let name = format!("{}-events.csv", asked.study);
    let table = behind(async move { Ok(events_table(&asked.app.store, &asked.selection).await?.csv()) });
    Ok(csv(&name, table.await?))
}

/// What each column of `events.csv` is, as a table.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/events_codebook.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_events_codebook_csv(asked: Asked) -> File {
    Ok(csv(&format!("{}-events-codebook.csv", asked.study), codebook_of(&events_codebook()).csv()))
}

/// What each column of `responses.csv` is, as a table.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/codebook.csv", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "A file to keep.", body = String, content_type = "text/csv"), Chosen)
)]
pub(crate) async fn get_codebook_csv(asked: Asked) -> File {
    Ok(csv(&format!("{}-codebook.csv", asked.study), codebook_csv()))
}

/// What each column of `responses.csv` is.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions/{version}/codebook.json", tag = "results", security(("researcher" = [])),
    params(VersionPath, Pooling),
    responses((status = OK, description = "The codebook.", body = Codebook), Chosen)
)]
pub(crate) async fn get_codebook(_: Asked) -> Answered<Codebook> {
    Ok(Fresh(Codebook { columns: codebook() }))
}

fn csv(name: &str, text: String) -> Response {
    download("text/csv; charset=utf-8", name, text)
}

/// A file to keep, which no browser opens in the console's own origin.
fn download(media_type: &str, name: &str, content: impl Into<Body>) -> Response {
    tracing::info!(target: AUDIT, file = name, "a file was taken");
    let headers = [
        (header::CONTENT_TYPE, media_type.to_owned()),
        (header::CONTENT_DISPOSITION, format!("attachment; filename=\"{name}\"")),
        (header::CACHE_CONTROL, "no-store".to_owned()),
    ];
    (headers, content.into()).into_response()
}
