//! Studies: what anybody may know of one, and the researchers' lists of them and of their versions.

use super::{Answered, Fresh};
use crate::api::{
    ListQuery, Progress, Study, StudyList, StudyStatus, StudySummary, StudyVersion, TrialKind, VersionList,
    refusals,
};
use crate::app::{App, LoadedStudy, Stimuli};
use crate::extract::{Parameters, Query, Researcher};
use axum::extract::State;
use kelir_report::Participants;
use kelir_store::StoreError;
use serde::Deserialize;
use std::sync::Arc;
use utoipa::IntoParams;

#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Path)]
pub(crate) struct StudyPath {
    /// The study's id.
    pub(crate) study: String,
}

refusals!(NoStudy: NotFound, NotReady, StimuliFailed);

/// What a study says of itself before anybody takes part.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}", tag = "participants", params(StudyPath),
    responses((status = OK, description = "The study.", body = Study), NoStudy)
)]
pub(crate) async fn get_study(
    State(app): State<Arc<App>>,
    Parameters(StudyPath { study }): Parameters<StudyPath>,
) -> Answered<Study> {
    let loaded = app.study(&study)?;
    loaded.ready()?;
    let study = &loaded.study;
    Ok(Fresh(Study {
        id: study.id.clone(),
        title: study.title.clone(),
        question: study.question.clone(),
        surround: study.surround,
        size: study.size,
        texts: study.texts.clone(),
        estimated_minutes: study.estimated_minutes,
        trial_kinds: vec![TrialKind::TwoAlternative],
    }))
}

refusals!(List: Unauthorized, InvalidParameter);

/// The studies that are served, by id.
#[utoipa::path(
    get, path = "/api/v1/studies", tag = "studies", security(("researcher" = [])), params(ListQuery),
    responses((status = OK, description = "A page of the list.", body = StudyList), List)
)]
pub(crate) async fn list_studies(
    _: Researcher,
    State(app): State<Arc<App>>,
    Query(query): Query<ListQuery>,
) -> Answered<StudyList> {
    let ids: Vec<&str> = app.studies.keys().map(String::as_str).collect();
    let page = query.page(&ids)?;
    let mut items = Vec::with_capacity(page.items.len());
    for id in page.items {
        items.push(summary(&app, app.study(id)?).await?);
    }
    Ok(Fresh(StudyList { items, next_cursor: page.next_cursor }))
}

async fn summary(app: &App, loaded: &LoadedStudy) -> Result<StudySummary, StoreError> {
    let study = &loaded.study;
    let (status, progress, reason) = match loaded.stimuli() {
        Stimuli::Ready(_) => (StudyStatus::Ready, None, None),
        Stimuli::Failed(reason) => (StudyStatus::Failed, None, Some(reason)),
        Stimuli::Preparing(making) => {
            let progress =
                making.map(|m| Progress { done: m.done, total: m.total, stimulus: m.stimulus.clone() });
            (StudyStatus::Preparing, progress, None)
        }
    };
    Ok(StudySummary {
        id: study.id.clone(),
        title: study.title.clone(),
        version: (status == StudyStatus::Ready).then(|| loaded.config_hash.clone()),
        file_hash: loaded.config_hash.clone(),
        status,
        progress,
        reason,
        most_trials: study.trial_count(),
        participants: participants(app, loaded).await?,
    })
}

async fn participants(app: &App, loaded: &LoadedStudy) -> Result<Participants, StoreError> {
    let counted = app.store.participants(&loaded.study.id, &loaded.config_hash, loaded.idle()).await?;
    Ok(crate::results::counted(counted))
}

refusals!(Versions: Unauthorized, InvalidParameter, NotFound);

/// The versions of a study, the one that is served first.
#[utoipa::path(
    get, path = "/api/v1/studies/{study}/versions", tag = "studies", security(("researcher" = [])),
    params(StudyPath, ListQuery),
    responses((status = OK, description = "A page of the list.", body = VersionList), Versions)
)]
pub(crate) async fn list_versions(
    _: Researcher,
    State(app): State<Arc<App>>,
    Parameters(StudyPath { study }): Parameters<StudyPath>,
    Query(query): Query<ListQuery>,
) -> Answered<VersionList> {
    let loaded = app.study(&study)?;
    let page = query.page(&[&loaded.config_hash])?;
    let mut items = Vec::with_capacity(page.items.len());
    for version in page.items {
        items.push(described(&app, loaded, version).await?);
    }
    Ok(Fresh(VersionList { items, next_cursor: page.next_cursor }))
}

/// What there is to say of a version.
async fn described(app: &App, loaded: &LoadedStudy, version: &str) -> Result<StudyVersion, StoreError> {
    let study = &loaded.study;
    let stored = app.store.study_versions(&study.id).await?.into_iter();
    let loaded_at =
        stored.filter(|stored| stored.config_hash == version).map(|stored| stored.loaded_at).next();
    let last_served_at = loaded_at.unwrap_or_default();
    let answered = app.store.answer_times(&study.id, version).await?.map(|(first, _)| first);
    let answers = loaded.answers(&app.store).await?;
    Ok(StudyVersion {
        version: version.to_owned(),
        design_hash: study.config_hash(),
        title: study.title.clone(),
        is_current: version == loaded.config_hash,
        first_served_at: answered.into_iter().chain([last_served_at.clone()]).min().unwrap_or_default(),
        last_served_at,
        participants: participants(app, loaded).await?,
        answers: answers.len() as u64,
        stimuli: app.store.study_stimuli(&study.id, version).await?.len(),
    })
}
