//! The versions of a study, with what each has gathered.

use kelir_report::Participants;
use kelir_store::{Store, StoreError};
use serde::Serialize;
use std::collections::HashMap;
use std::time::Duration;
use utoipa::ToSchema;

/// A version of a study: what was asked and what was shown.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct StudyVersion {
    /// Its hash.
    pub version: String,
    /// Hash of its definition alone.
    pub design_hash: String,
    /// Title at the time.
    pub title: String,
    /// Whether it is the one that is served.
    pub is_current: bool,
    /// When it was first served, ISO-8601 UTC.
    pub first_served_at: String,
    /// When it was last loaded to be served, ISO-8601 UTC.
    pub last_served_at: String,
    /// How many people took part in it.
    pub participants: Participants,
    /// Answers to it.
    pub answers: u64,
    /// Stimuli that it shows.
    pub stimuli: usize,
}

/// The versions of a study, the one that is served (`current`; absent: that was served last) first, with what each has gathered.
///
/// # Errors
/// The store cannot be read.
pub async fn versions(
    store: &Store,
    study_id: &str,
    current: Option<&str>,
) -> Result<Vec<StudyVersion>, StoreError> {
    let known = stored(store, study_id, current).await?;
    let Some(idle) = known.first().map(|first| 60 * u64::from(first.study.idle_minutes)) else {
        return Ok(Vec::new());
    };
    let counts = store.version_counts(study_id, Duration::from_secs(idle)).await?;
    let mut versions = Vec::with_capacity(known.len());
    for (place, version) in known.into_iter().enumerate() {
        let gathered = counts.get(&version.version).copied().unwrap_or_default();
        versions.push(StudyVersion {
            is_current: place == 0,
            title: version.study.title,
            participants: counted(gathered.participants),
            answers: gathered.answers,
            stimuli: store.version_stimuli(study_id, &version.version).await?.len(),
            version: version.version,
            design_hash: version.design_hash,
            first_served_at: version.first_served_at,
            last_served_at: version.last_served_at,
        });
    }
    Ok(versions)
}

/// What is stored of the versions, in the same order.
pub(crate) async fn stored(
    store: &Store,
    study_id: &str,
    current: Option<&str>,
) -> Result<Vec<kelir_store::StudyVersion>, StoreError> {
    let mut known = store.study_versions(study_id).await?;
    if let Some(at) = known.iter().position(|version| Some(version.version.as_str()) == current) {
        known[..=at].rotate_right(1);
    }
    Ok(known)
}

/// The store's counts as the report has them.
pub fn counted(people: kelir_store::Participants) -> Participants {
    Participants { started: people.started, in_progress: people.in_progress, completed: people.completed }
}

/// Hash of the design of each version.
pub(crate) async fn designs(store: &Store, study_id: &str) -> Result<HashMap<String, String>, StoreError> {
    let versions = store.study_versions(study_id).await?;
    Ok(versions.into_iter().map(|version| (version.version, version.design_hash)).collect())
}
