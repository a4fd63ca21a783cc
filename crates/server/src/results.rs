//! What came of a study, as the console and `kelir stats` show it.

use kelir_store::{Participants, Store, StoreError, StudyStimulus};
use kelir_study::StudyDefinition;
use kelir_study::analysis::{Answer, BlockSummary, summarise};
use serde::Serialize;
use std::time::Duration;

/// Results of one version of a study.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Study's id.
    pub study: String,
    /// Study's title.
    pub title: String,
    /// Version of the study that these results are of.
    pub config_hash: String,
    /// How many people take part.
    pub participants: Participants,
    /// The paper's test for each block.
    pub blocks: Vec<BlockSummary>,
    /// What was shown, with how it was made and its measured error.
    pub stimuli: Vec<StudyStimulus>,
    /// Other versions of the study that have sessions; their answers are not in these results.
    pub other_versions: Vec<OtherVersion>,
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
pub async fn results(store: &Store, study: &StudyDefinition) -> Result<Results, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let rows = store.responses(&study.id, &config_hash).await?;
    let answers = rows.iter().map(|(row, _)| Answer {
        session_id: &row.session_id,
        block_id: &row.block_id,
        pair_id: &row.pair_id,
        chosen_condition: &row.chosen_condition,
    });
    let other =
        store.sessions_by_version(&study.id).await?.into_iter().filter(|(hash, _)| *hash != config_hash);
    Ok(Results {
        study: study.id.clone(),
        title: study.title.clone(),
        participants: store.participants(&study.id, &config_hash, idle).await?,
        blocks: summarise(study, answers),
        stimuli: store.study_stimuli(&study.id, &config_hash).await?,
        other_versions: other.map(|(config_hash, sessions)| OtherVersion { config_hash, sessions }).collect(),
        config_hash,
    })
}
