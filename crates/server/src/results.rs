//! What came of a study, as the console and `kelir stats` show it.

use kelir_store::{AnswerRow, Participants, Store, StoreError, StudyStimulus};
use kelir_study::StudyDefinition;
use kelir_study::analysis::{Answer, BlockSummary, summarise};
use kelir_study::screening::{Exclusion, Seen, screen};
use serde::Serialize;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Results of one version of a study.
#[derive(Clone, Debug, Serialize)]
pub struct StudyResults {
    /// Study's id.
    pub study: String,
    /// Study's title.
    pub title: String,
    /// Version of the study that these results are of.
    pub config_hash: String,
    /// How many people take part.
    pub participants: Participants,
    /// Who is left out by the study's rules of screening, and why.
    pub excluded: Vec<Excluded>,
    /// The paper's test for each block, without the excluded.
    pub blocks: Vec<BlockSummary>,
    /// The same with everybody; null when nobody is excluded.
    pub blocks_with_excluded: Option<Vec<BlockSummary>>,
    /// What was shown, with how it was made and its measured error.
    pub stimuli: Vec<StudyStimulus>,
    /// Other versions of the study that have sessions; their answers are not in these results.
    pub other_versions: Vec<OtherVersion>,
}

/// A participant who is left out.
#[derive(Clone, Debug, Serialize)]
pub struct Excluded {
    /// Session's id.
    pub session_id: String,
    /// Every reason there is.
    pub reasons: Vec<Exclusion>,
}

/// A version of the study that the results leave out.
#[derive(Clone, Debug, Serialize)]
pub struct OtherVersion {
    /// Hash of its definition.
    pub config_hash: String,
    /// Sessions begun with it.
    pub sessions: u64,
}

/// Computes the results of this version of a study from what is stored now.
///
/// # Errors
/// The store cannot be read.
pub async fn results(store: &Store, study: &StudyDefinition) -> Result<StudyResults, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let answers = store.answers(&study.id, &config_hash).await?;
    let excluded = exclusions(study, &answers);
    let left_out: HashSet<&str> = excluded.iter().map(|e| e.session_id.as_str()).collect();
    let blocks = summarise(study, answers.iter().map(answer).filter(|a| !left_out.contains(a.session_id)));
    let everybody = (!excluded.is_empty()).then(|| summarise(study, answers.iter().map(answer)));
    let other =
        store.sessions_by_version(&study.id).await?.into_iter().filter(|(hash, _)| *hash != config_hash);
    Ok(StudyResults {
        study: study.id.clone(),
        title: study.title.clone(),
        participants: store.participants(&study.id, &config_hash, idle).await?,
        blocks,
        blocks_with_excluded: everybody,
        excluded,
        stimuli: store.study_stimuli(&study.id, &config_hash).await?,
        other_versions: other.map(|(config_hash, sessions)| OtherVersion { config_hash, sessions }).collect(),
        config_hash,
    })
}

fn answer(row: &AnswerRow) -> Answer<'_> {
    Answer {
        session_id: &row.session_id,
        block_id: &row.block_id,
        pair_id: &row.pair_id,
        chosen_condition: row.chosen_condition(),
    }
}

/// Who is left out; `answers` as the store gives them, those of a session together. Sessions without any answer are not among them.
fn exclusions<'a>(study: &StudyDefinition, answers: &'a [AnswerRow]) -> Vec<Excluded> {
    let sessions = answers.chunk_by(|a, b| a.session_id == b.session_id);
    let judged = sessions.map(|rows| {
        let seen = |row: &'a AnswerRow| Seen {
            block_id: &row.block_id,
            chosen_condition: row.chosen_condition(),
            chose_left: row.chose_left,
            rt_ms: row.rt_ms,
        };
        let seen: Vec<Seen<'_>> = rows.iter().map(seen).collect();
        Excluded { session_id: rows[0].session_id.clone(), reasons: screen(study, &seen) }
    });
    judged.filter(|e| !e.reasons.is_empty()).collect()
}

/// Why there are no results.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The folder is no data folder of kelir.
    #[error("{0}: holds no kelir.sqlite; give the folder that `kelir serve` was started with")]
    NoData(PathBuf),
    /// No study of this name was ever served from the folder.
    #[error("study = {study:?}: must be one of {}", .known.join(", "))]
    UnknownStudy {
        /// The name asked for.
        study: String,
        /// The studies there are.
        known: Vec<String>,
    },
    /// The data cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The results of a study's latest version, from a data folder; a server may be using it at the same time.
///
/// # Errors
/// There is no such data folder or study, or it cannot be read.
pub async fn of_study(data: &Path, study: &str) -> Result<StudyResults, ResultsError> {
    let (store, study) = open_study(data, study).await?;
    let results = results(&store, &study).await;
    store.close().await;
    Ok(results?)
}

/// A data folder's store, and the latest version of a study in it.
///
/// # Errors
/// As [`of_study`].
pub async fn open_study(data: &Path, study: &str) -> Result<(Store, StudyDefinition), ResultsError> {
    if !data.join("kelir.sqlite").is_file() {
        return Err(ResultsError::NoData(data.to_owned()));
    }
    let store = Store::open(data).await?;
    match store.study_versions(study).await?.into_iter().next() {
        Some(version) => Ok((store, version.study)),
        None => {
            let known = store.study_ids().await?;
            store.close().await;
            Err(ResultsError::UnknownStudy { study: study.to_owned(), known })
        }
    }
}
