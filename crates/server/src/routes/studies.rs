//! Studies: what anybody may know of one, and the researchers' lists of them and of their versions.

use super::{Answered, Fresh};
use crate::api::{
    Display, ListQuery, Progress, Study, StudyList, StudyStatus, StudySummary, VersionList, refusals,
};
use crate::app::App;
use crate::extract::{Parameters, Query, Researcher};
use crate::loaded::{BrokenStudy, LoadedStudy, Stimuli, idle};
use axum::extract::State;
use kelir_house::versions::{counted, versions};
use kelir_report::Participants;
use kelir_store::StoreError;
use kelir_study::StudyDefinition;
use serde::Deserialize;
use std::collections::BTreeSet;
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
    Ok(Fresh(told(&loaded.study)))
}

/// What participants are told of a study.
pub(super) fn told(study: &StudyDefinition) -> Study {
    Study {
        id: study.id.clone(),
        title: study.title.clone(),
        question: study.question.clone(),
        surround: study.surround,
        size: study.size,
        display: Display { sizes: study.sizes().to_vec(), fit: study.fit() },
        texts: study.texts.clone(),
        language: study.language.clone(),
        translations: study.translations.clone(),
        estimated_minutes: study.estimated_minutes,
        response: study.response_rules(),
        per_visit: study.session.per_visit,
        trial_kinds: study.trial_names(),
    }
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
    let ids: BTreeSet<&str> = app.studies.keys().chain(app.broken.keys()).map(String::as_str).collect();
    let ids: Vec<&str> = ids.into_iter().collect();
    let page = query.page(&ids)?;
    let mut items = Vec::with_capacity(page.items.len());
    for id in page.items {
        items.push(match app.broken.get(id) {
            Some(broken) => of_broken(broken),
            None => summary(&app, app.study(id)?).await?,
        });
    }
    Ok(Fresh(StudyList { items, next_cursor: page.next_cursor }))
}

/// A study whose file is wrong, as the list has it.
fn of_broken(broken: &BrokenStudy) -> StudySummary {
    StudySummary {
        id: broken.id.clone(),
        title: broken.id.clone(),
        version: None,
        file_hash: broken.file_hash.clone(),
        status: StudyStatus::Failed,
        progress: None,
        reason: Some(broken.reason.clone()),
        warnings: Vec::new(),
        most_trials: 0,
        participants: Participants::default(),
    }
}

async fn summary(app: &App, loaded: &LoadedStudy) -> Result<StudySummary, StoreError> {
    let study = &loaded.study;
    let version = app.current(&study.id);
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
        participants: match &version {
            Some(version) => app.store.version_counts(&study.id, idle(&loaded.study)).await?.remove(version),
            None => None,
        }
        .map(|gathered| counted(gathered.participants))
        .unwrap_or_default(),
        version,
        file_hash: loaded.file_hash.clone(),
        status,
        progress,
        reason,
        warnings: loaded.warnings.clone(),
        most_trials: study.most_trials(),
    })
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
    let current = app.current(&study);
    let versions = versions(&app.store, &study, current.as_deref()).await?;
    if versions.is_empty() {
        app.study(&study)?;
    }
    let keys: Vec<&str> = versions.iter().map(|version| version.version.as_str()).collect();
    let page = query.page(&keys)?;
    let items = versions.iter().filter(|version| page.items.contains(&version.version.as_str()));
    Ok(Fresh(VersionList { items: items.cloned().collect(), next_cursor: page.next_cursor }))
}
