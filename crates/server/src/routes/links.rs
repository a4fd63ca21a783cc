//! Links by which a study is tried: made for researchers, looked at for whoever follows one.

use super::studies::StudyPath;
use super::{Answered, Fresh};
use crate::api::{Link, NewLink, Problem, ProblemCode, VisitKind, refusals};
use crate::app::App;
use crate::extract::{Body, Parameters, Researcher, SignedIn};
use axum::extract::{RawQuery, State};
use axum::http::Uri;
use kelir_house::links::{Pairs, Visit, now};
use std::sync::Arc;

refusals!(NoLink: Unauthorized, NotFound, BadBody, BadJson, NotJson, TooLarge, InvalidField);

/// Make a link by which a study may be tried by who has it.
#[utoipa::path(
    post, path = "/api/v1/studies/{study}/links", tag = "studies", security(("researcher" = [])), params(StudyPath), request_body = NewLink,
    responses((status = OK, description = "The link.", body = Link), NoLink)
)]
pub(crate) async fn make_link(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(StudyPath { study }): Parameters<StudyPath>,
    Body(NewLink { visit, days }): Body<NewLink>,
) -> Answered<Link> {
    app.study(&study)?;
    let expires = now() + 86_400 * u64::from(days.unwrap_or(7));
    Ok(Fresh(Link { path: app.links.link(&study, visit.into(), expires), expires_at_s: expires }))
}

refusals!(NoVisit: NotFound, LinkRefused);

/// What the link of this query makes of a visit to a study. The parameters are those of the link itself.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/visit", tag = "participants", params(StudyPath),
    responses((status = OK, description = "The visit.", body = VisitKind), NoVisit)
)]
pub(crate) async fn get_visit(
    State(app): State<Arc<App>>,
    Parameters(StudyPath { study }): Parameters<StudyPath>,
    SignedIn(researcher): SignedIn,
    RawQuery(query): RawQuery,
) -> Answered<VisitKind> {
    app.study(&study)?;
    let pairs = decoded(&query.unwrap_or_default());
    Ok(Fresh(VisitKind { visit: visit(&app, &study, &pairs, researcher.is_some())? }))
}

/// What a link's parameters make of a visit.
pub(super) fn visit(
    app: &App,
    study: &str,
    pairs: &Pairs,
    is_researcher: bool,
) -> Result<Visit, Box<Problem>> {
    let refused = |why| Problem::new(ProblemCode::LinkRefused, why);
    app.links.visit(study, pairs, is_researcher, now()).map_err(refused)
}

/// A query's parameters; none where it cannot be read, as a participant's link may be anything.
fn decoded(query: &str) -> Vec<(String, String)> {
    let address = format!("/?{query}").parse::<Uri>();
    let read = |uri: Uri| axum::extract::Query::<Vec<(String, String)>>::try_from_uri(&uri).ok();
    address.ok().and_then(read).map_or_else(Vec::new, |axum::extract::Query(pairs)| pairs)
}
