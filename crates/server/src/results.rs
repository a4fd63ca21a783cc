//! What came of a study, as the console and `kelir stats` show it.

use crate::export::write_row;
use kelir_report::{Chain, StudyReport};
use kelir_stats::paper::taylor_cameron;
use kelir_store::{AnswerRow, Answers, Participants, Store, StoreError, StudyStimulus};
use kelir_study::analysis::{Answer, BlockSummary, summarise};
use kelir_study::report::{Observation, Report};
use kelir_study::screening::{Seen, screen};
use kelir_study::{Screening, StudyDefinition};
use serde::Serialize;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

pub use kelir_report::{Excluded, OtherVersion};

/// The study that repeats the paper's survey, and so has the paper's own tests beside its own.
const PAPER_STUDY: &str = "shadow-puppets";

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

/// Computes the results of this version of a study from what is stored now.
///
/// # Errors
/// The store cannot be read.
pub async fn results(store: &Store, study: &StudyDefinition) -> Result<StudyResults, StoreError> {
    results_of(store, study, &read(store, study).await?).await
}

async fn read(store: &Store, study: &StudyDefinition) -> Result<Answers, StoreError> {
    let mut answers = Answers::default();
    store.read_on(&mut answers, &study.id, &study.config_hash()).await?;
    Ok(answers)
}

/// The same from answers that have been read.
pub(crate) async fn results_of(
    store: &Store,
    study: &StudyDefinition,
    answers: &Answers,
) -> Result<StudyResults, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let answers = answers.rows();
    let excluded = exclusions(study, answers);
    let left_out: HashSet<&str> = excluded.iter().map(|e| e.session_id.as_str()).collect();
    let blocks = summarise(study, answers.iter().map(answer).filter(|a| !left_out.contains(a.session_id)));
    let everybody = (!excluded.is_empty()).then(|| summarise(study, answers.iter().map(answer)));
    Ok(StudyResults {
        study: study.id.clone(),
        title: study.title.clone(),
        participants: store.participants(&study.id, &config_hash, idle).await?,
        blocks,
        blocks_with_excluded: everybody,
        excluded,
        stimuli: store.study_stimuli(&study.id, &config_hash).await?,
        other_versions: other_versions(store, &study.id, &config_hash).await?,
        config_hash,
    })
}

/// The full report of this version of a study from what is stored now. Resampling takes a while with many participants.
///
/// # Errors
/// The store cannot be read.
pub async fn report(store: &Store, study: &StudyDefinition) -> Result<StudyReport, StoreError> {
    report_of(store, study, &read(store, study).await?).await
}

/// The same from answers that have been read.
pub(crate) async fn report_of(
    store: &Store,
    study: &StudyDefinition,
    answers: &Answers,
) -> Result<StudyReport, StoreError> {
    let config_hash = study.config_hash();
    let idle = Duration::from_secs(60 * u64::from(study.idle_minutes));
    let answers = answers.rows();
    let excluded = exclusions(study, answers);
    let left_out = names(&excluded);
    let everybody: Vec<Observation<'_>> = answers.iter().map(observation).collect();
    let judged: Vec<Observation<'_>> =
        everybody.iter().filter(|o| !left_out.contains(o.answer.session_id)).copied().collect();
    let report = Report::of(study, &judged);
    let (with_excluded, scale_with_excluded) = if excluded.is_empty() {
        (None, None)
    } else {
        let everybody = Report::of(study, &everybody);
        (Some(everybody.blocks), everybody.scale)
    };
    let people = store.participants(&study.id, &config_hash, idle).await?;
    let shown = store.study_stimuli(&study.id, &config_hash).await?.into_iter();
    let chain = store.verify_chain().await?;
    Ok(StudyReport {
        study: study.id.clone(),
        title: study.title.clone(),
        question: study.question.clone(),
        kelir_version: env!("CARGO_PKG_VERSION").to_owned(),
        answered: store.answer_times(&study.id, &config_hash).await?.map(|(first, last)| [first, last]),
        participants: kelir_report::Participants {
            started: people.started,
            in_progress: people.in_progress,
            completed: people.completed,
        },
        screening: study.screening.clone(),
        report,
        blocks_with_excluded: with_excluded,
        scale_with_excluded,
        excluded,
        stimuli: shown
            .map(|StudyStimulus { pair, condition, sha256, provenance }| kelir_report::Stimulus {
                pair,
                condition,
                sha256,
                provenance,
            })
            .collect(),
        other_versions: other_versions(store, &study.id, &config_hash).await?,
        chain: Chain { rows: chain.rows, head: chain.head, broken: chain.broken, blanked: chain.blanked },
        paper: taylor_cameron().ok().filter(|_| study.id == PAPER_STUDY),
        design: study.clone(),
        config_hash,
    })
}

/// Choices as pwcmp reads them, one row a trial: `observer, session, scene, condition_A, condition_B, is_A_selected`, and
/// `left_condition`, since A and B are the block's conditions in file order and never mean sides. Without the excluded
/// and without catch blocks.
///
/// # Errors
/// The store cannot be read.
pub async fn pairs_csv(store: &Store, study: &StudyDefinition) -> Result<String, StoreError> {
    let config_hash = study.config_hash();
    let answers = read(store, study).await?;
    let answers = answers.rows();
    let excluded = exclusions(study, answers);
    let left_out = names(&excluded);
    let sessions = store.sessions(&study.id, &config_hash).await?;
    let observers: HashMap<&str, &str> =
        sessions.iter().map(|s| (s.session_id.as_str(), s.subject_id.as_str())).collect();
    let mut out = String::new();
    let header =
        ["observer", "session", "scene", "condition_A", "condition_B", "is_A_selected", "left_condition"];
    write_row(&mut out, header.map(str::to_owned));
    for row in answers.iter().filter(|row| !left_out.contains(&*row.session_id)) {
        let Some(block) = study.block(&row.block_id).filter(|block| !block.catch) else { continue };
        let [a, b] = &block.conditions;
        let observer = observers.get(&*row.session_id).copied().unwrap_or_default();
        let selected = u8::from(row.chosen_condition() == a).to_string();
        let cells = [observer, &row.session_id, &row.pair_id, a, b, &selected, &row.left_condition];
        write_row(&mut out, cells.map(str::to_owned));
    }
    Ok(out)
}

fn names(excluded: &[Excluded]) -> HashSet<&str> {
    excluded.iter().map(|e| e.session_id.as_str()).collect()
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

fn observation(row: &AnswerRow) -> Observation<'_> {
    Observation { answer: answer(row), chose_left: row.chose_left, rt_ms: row.rt_ms }
}

fn answer(row: &AnswerRow) -> Answer<'_> {
    Answer {
        session_id: &row.session_id,
        block_id: &row.block_id,
        pair_id: &row.pair_id,
        chosen_condition: row.chosen_condition(),
    }
}

/// Who is left out, in the order they began. Sessions without any answer are not among them.
fn exclusions(study: &StudyDefinition, answers: &[AnswerRow]) -> Vec<Excluded> {
    if study.screening == Screening::default() {
        return Vec::new();
    }
    let mut sessions: BTreeMap<&str, Vec<Seen<'_>>> = BTreeMap::new();
    for row in answers {
        sessions.entry(&row.session_id).or_default().push(Seen {
            block_id: &row.block_id,
            chosen_condition: row.chosen_condition(),
            chose_left: row.chose_left,
            rt_ms: row.rt_ms,
        });
    }
    let judged = sessions
        .into_iter()
        .map(|(id, seen)| Excluded { session_id: id.to_owned(), reasons: screen(study, &seen) });
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
