//! What came of a study, as the console and `kelir stats` show it.

use crate::export::write_row;
use kelir_report::{Chain, Participants, Stimulus, StudyReport};
use kelir_stats::pairwise::Scale;
use kelir_stats::paper::taylor_cameron;
use kelir_store::{Store, StoreError, StoredAnswers};
use kelir_study::StudyDefinition;
use kelir_study::analysis::{BlockSummary, conditions_scale, summarise};
use kelir_study::answers::{Answers, Participant, blocks};
use kelir_study::report::Report;
use kelir_study::screening::screen;
use serde::Serialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use utoipa::ToSchema;

pub use kelir_report::{Excluded, OtherVersion};

/// The study that repeats the paper's survey, and so has the paper's own tests beside its own.
const PAPER_STUDY: &str = "shadow-puppets";

/// Results of one version of a study.
#[derive(Clone, Debug, Serialize, ToSchema)]
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
    /// All conditions on one axis, without the excluded; its standard errors take choices as independent, see the report.
    pub scale: Option<Scale>,
    /// Why there is no scale.
    pub scale_note: Option<String>,
    /// What was shown, with how it was made and its measured error.
    pub stimuli: Vec<Stimulus>,
    /// Other versions of the study that have sessions; their answers are not in these results.
    pub other_versions: Vec<OtherVersion>,
}

/// Computes the results of this version of a study from what is stored now.
///
/// # Errors
/// The store cannot be read.
pub async fn results(store: &Store, study: &StudyDefinition) -> Result<StudyResults, StoreError> {
    let answers = read(store, study).await?;
    results_of(store, study, &answers).await
}

async fn read(store: &Store, study: &StudyDefinition) -> Result<Arc<Answers>, StoreError> {
    let mut stored = StoredAnswers::new(study);
    store.read_on(&mut stored).await?;
    Ok(stored.answers())
}

/// The same from answers that have been read.
pub(crate) async fn results_of(
    store: &Store,
    study: &StudyDefinition,
    answers: &Answers,
) -> Result<StudyResults, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let (everybody, judged, excluded) = screened(study, answers);
    let blocks = summarise(study, &judged);
    let (scale, scale_note) = match conditions_scale(study, &judged) {
        Ok(scale) => (Some(scale), None),
        Err(note) => (None, Some(note)),
    };
    Ok(StudyResults {
        study: study.id.clone(),
        title: study.title.clone(),
        participants: counted(store.participants(&study.id, &config_hash, idle).await?),
        blocks,
        blocks_with_excluded: (!excluded.is_empty()).then(|| summarise(study, &everybody)),
        scale,
        scale_note,
        excluded,
        stimuli: shown(store, &study.id, &config_hash).await?,
        other_versions: other_versions(store, &study.id, &config_hash).await?,
        config_hash,
    })
}

/// The full report of this version of a study from what is stored now. Resampling takes a while with many participants.
///
/// # Errors
/// The store cannot be read.
pub async fn report(store: &Store, study: &StudyDefinition) -> Result<StudyReport, StoreError> {
    let answers = read(store, study).await?;
    report_of(store, study, &answers).await
}

/// The same from answers that have been read.
pub(crate) async fn report_of(
    store: &Store,
    study: &StudyDefinition,
    answers: &Answers,
) -> Result<StudyReport, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let (everybody, judged, excluded) = screened(study, answers);
    let report = Report::of(study, &judged);
    let (with_excluded, scale_with_excluded) = if excluded.is_empty() {
        (None, None)
    } else {
        let everybody = Report::of(study, &everybody);
        (Some(everybody.blocks), everybody.scale)
    };
    let chain = store.verify_chain().await?;
    Ok(StudyReport {
        study: study.id.clone(),
        title: study.title.clone(),
        question: study.question.clone(),
        kelir_version: env!("CARGO_PKG_VERSION").to_owned(),
        answered: store.answer_times(&study.id, &config_hash).await?.map(|(first, last)| [first, last]),
        participants: counted(store.participants(&study.id, &config_hash, idle).await?),
        screening: study.screening.clone(),
        report,
        blocks_with_excluded: with_excluded,
        scale_with_excluded,
        excluded,
        stimuli: shown(store, &study.id, &config_hash).await?,
        other_versions: other_versions(store, &study.id, &config_hash).await?,
        chain: Chain { rows: chain.rows, head: chain.head, broken: chain.broken, blanked: chain.blanked },
        paper: taylor_cameron().ok().filter(|_| study.id == PAPER_STUDY),
        design: study.clone(),
        config_hash,
    })
}

/// Choices as pwcmp reads them, one row a trial: `observer, session, scene, condition_A, condition_B, is_A_selected`, and
/// `left_condition`, since A and B are the block's conditions in file order and never mean sides. By participants in the order
/// they began and pairs in file order, without the excluded and without catch blocks.
///
/// # Errors
/// The store cannot be read.
pub async fn pairs_csv(store: &Store, study: &StudyDefinition) -> Result<String, StoreError> {
    let answers = read(store, study).await?;
    let (_, judged, _) = screened(study, &answers);
    let sessions = store.sessions(&study.id, &study.config_hash()).await?;
    let observers: HashMap<&str, &str> =
        sessions.iter().map(|s| (s.session_id.as_str(), s.subject_id.as_str())).collect();
    let mut out = String::new();
    let header =
        ["observer", "session", "scene", "condition_A", "condition_B", "is_A_selected", "left_condition"];
    write_row(&mut out, header.map(str::to_owned));
    for participant in judged {
        let session = &*participant.session_id;
        let observer = observers.get(session).copied().unwrap_or_default();
        for (block, pairs) in blocks(study).filter(|(block, _)| !block.catch) {
            let [a, b] = &block.conditions;
            for given in participant.answers_to(&pairs) {
                let pair = &block.items[(given.item - pairs.start) as usize];
                let chose = |target: bool| if target { block.target.as_str() } else { block.other() };
                let selected = if chose(given.chose_target) == a { "1" } else { "0" };
                let left = chose(given.chose_target == given.chose_left);
                write_row(&mut out, [observer, session, &pair.id, a, b, selected, left].map(str::to_owned));
            }
        }
    }
    Ok(out)
}

/// The store's count as reports have it.
pub(crate) fn counted(people: kelir_store::Participants) -> Participants {
    let kelir_store::Participants { started, in_progress, completed } = people;
    Participants { started, in_progress, completed }
}

/// What a version shows, as reports have it.
async fn shown(store: &Store, study_id: &str, config_hash: &str) -> Result<Vec<Stimulus>, StoreError> {
    let stored = store.study_stimuli(study_id, config_hash).await?.into_iter();
    let stimulus = |kelir_store::StudyStimulus { pair, condition, sha256, provenance }| Stimulus {
        pair,
        condition,
        sha256,
        provenance,
    };
    Ok(stored.map(stimulus).collect())
}

async fn other_versions(
    store: &Store,
    study_id: &str,
    config_hash: &str,
) -> Result<Vec<OtherVersion>, StoreError> {
    let versions = store.sessions_by_version(study_id).await?.into_iter();
    let other = versions.filter(|(hash, _)| hash != config_hash);
    Ok(other.map(|(config_hash, sessions)| OtherVersion { config_hash, sessions }).collect())
}

/// Everybody who answered, those whom no rule leaves out, and the others with the reasons; each in the order they began.
/// Sessions without any answer are not among them.
fn screened<'a>(
    study: &StudyDefinition,
    answers: &'a Answers,
) -> (Vec<&'a Participant>, Vec<&'a Participant>, Vec<Excluded>) {
    let everybody = answers.participants();
    let (mut judged, mut excluded) = (Vec::with_capacity(everybody.len()), Vec::new());
    for &participant in &everybody {
        let reasons = screen(study, participant);
        if reasons.is_empty() {
            judged.push(participant);
        } else {
            excluded.push(Excluded { session_id: participant.session_id.to_string(), reasons });
        }
    }
    (everybody, judged, excluded)
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

/// The full report of a study's latest version, from a data folder.
///
/// # Errors
/// As [`of_study`].
pub async fn report_of_study(data: &Path, study: &str) -> Result<StudyReport, ResultsError> {
    let (store, study) = open_study(data, study).await?;
    let report = report(&store, &study).await;
    store.close().await;
    Ok(report?)
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
