//! What came of a study, as the console and `kelir stats` show it.

use crate::participants::of_session;
use crate::selection::{Selection, SelectionError, VersionRef, With};
use crate::weight::{Download, downloads};
use kelir_report::{
    Chain, DeviceCount, DifferentStimulus, Fault, Participants, PooledVersion, Served, ShownAt, Standing,
    Stimulus, StudyReport,
};
use kelir_stats::pairwise::Scale;
use kelir_stats::paper::taylor_cameron;
use kelir_store::{ShownSize, Store, StoreError, StoredAnswers, StudyStimulus};
use kelir_study::analysis::{BlockSummary, conditions_scale, summarise};
use kelir_study::answers::Answers;
use kelir_study::columns::ParticipantColumns;
use kelir_study::report::Report;
use kelir_study::visits::{Judged, LeftOut, SessionKind, Visit};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use utoipa::ToSchema;

pub use kelir_report::Excluded;

/// The study that repeats the paper's survey, and so has the paper's own tests beside its own.
const PAPER_STUDY: &str = "shadow-puppets";

/// Results of one version of a study, or of several pooled by name.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct StudyResults {
    /// Study's id.
    pub study: String,
    /// Study's title.
    pub title: String,
    /// Version of the study that these results are of.
    pub version: String,
    /// The versions whose answers are in, the one above first.
    pub pooled: Vec<PooledVersion>,
    /// What the pooled versions do not show alike.
    pub different_stimuli: Vec<DifferentStimulus>,
    /// How many people take part.
    pub participants: Participants,
    /// Who is judged, and who is not.
    pub standing: Standing,
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
    /// In which size whom a stimulus is shown, in words.
    pub display: String,
    /// What a participant downloads at each of the sizes; empty where some stimuli are not packed.
    pub downloads: Vec<Download>,
    /// Other versions of the study that have sessions; their answers are not in these results.
    pub other_versions: Vec<PooledVersion>,
}

/// Computes the results of the chosen versions from what is stored now.
///
/// # Errors
/// The store cannot be read.
pub async fn results(store: &Store, selection: &Selection) -> Result<StudyResults, StoreError> {
    let answers = read(store, selection).await?;
    results_of(store, selection, &answers).await
}

pub(crate) async fn read(store: &Store, selection: &Selection) -> Result<Arc<Answers>, StoreError> {
    let mut stored = StoredAnswers::new(&selection.study, &selection.versions);
    store.read_on(&mut stored).await?;
    Ok(stored.answers())
}

/// The same from answers that have been read.
///
/// # Errors
/// The store cannot be read.
pub async fn results_of(
    store: &Store,
    selection: &Selection,
    answers: &Answers,
) -> Result<StudyResults, StoreError> {
    let study = &selection.study;
    let visits = selection.visits(store).await?;
    let judged = Judged::of(study, answers, &visits, &selection.include.0);
    let (participants, excluded) = (participants(&visits), excluded(&judged));
    let (scale, scale_note) = match conditions_scale(study, &judged.judged) {
        Ok(scale) => (Some(scale), None),
        Err(note) => (None, Some(note)),
    };
    let (pooled, other_versions) = selection.gathered(store).await?;
    let (stimuli, different_stimuli) = selection.shown(store).await?;
    Ok(StudyResults {
        study: study.id.clone(),
        title: study.title.clone(),
        version: selection.version().to_owned(),
        pooled,
        different_stimuli,
        participants,
        standing: standing(selection, &judged).summarised(&participants, &excluded, &other_versions),
        blocks: summarise(study, &judged.judged),
        blocks_with_excluded: (!excluded.is_empty()).then(|| summarise(study, &judged.everybody)),
        scale,
        scale_note,
        excluded,
        stimuli: stimuli.into_iter().map(stimulus).collect(),
        display: study.display_in_words(),
        downloads: downloads(store, &study.id, selection.version()).await?,
        other_versions,
    })
}

/// How many people take part, as their sessions say.
fn participants(visits: &[Visit]) -> Participants {
    let people = visits.iter().filter(|visit| visit.kind == SessionKind::Participant);
    people.fold(Participants::default(), |sum, visit| Participants {
        started: sum.started + 1,
        in_progress: sum.in_progress + u64::from(visit.is_active),
        completed: sum.completed + u64::from(visit.completed_us.is_some()),
    })
}

fn standing(selection: &Selection, judged: &Judged<'_>) -> Standing {
    Standing::of(&selection.study, judged, &selection.include.0)
}

fn stimulus(shown: StudyStimulus) -> Stimulus {
    let StudyStimulus { item, condition, sha256, pixels_sha256, size, provenance } = shown;
    Stimulus { item, condition, size, sha256, pixels_sha256, provenance }
}

/// The full report of the chosen versions from what is stored now. Resampling takes a while with many participants.
///
/// # Errors
/// The store cannot be read.
pub async fn report(store: &Store, selection: &Selection) -> Result<StudyReport, StoreError> {
    let answers = read(store, selection).await?;
    report_of(store, selection, &answers).await
}

/// The same from answers that have been read.
///
/// # Errors
/// The store cannot be read.
pub async fn report_of(
    store: &Store,
    selection: &Selection,
    answers: &Answers,
) -> Result<StudyReport, StoreError> {
    let study = &selection.study;
    let visits = selection.visits(store).await?;
    let judged = Judged::of(study, answers, &visits, &selection.include.0);
    let (participants, excluded) = (participants(&visits), excluded(&judged));
    let report = Report::of(study, &judged.judged);
    let (with_excluded, scale_with_excluded) = if excluded.is_empty() {
        (None, None)
    } else {
        let everybody = Report::of(study, &judged.everybody);
        (Some(everybody.blocks), everybody.scale)
    };
    let (pooled, other_versions) = selection.gathered(store).await?;
    let (stimuli, different_stimuli) = selection.shown(store).await?;
    let shown = shown_at(store, selection, &judged).await?;
    let devices = devices(store, selection, &judged).await?;
    let known = store.study_versions(&study.id).await?;
    let served = known.into_iter().find(|version| version.version == selection.version());
    let chain = store.verify_chain(&study.id).await?;
    let times = store.answer_times(&study.id, &selection.versions).await?;
    Ok(StudyReport {
        study: study.id.clone(),
        title: study.title.clone(),
        question: study.question.clone(),
        version: selection.version().to_owned(),
        pooled,
        different_stimuli,
        kelir_version: env!("CARGO_PKG_VERSION").to_owned(),
        answered: times.map(|(first, last)| [first, last]),
        served: served.map(|v| Served { first: v.first_served_at, last: v.last_served_at }),
        participants,
        standing: standing(selection, &judged).summarised(&participants, &excluded, &other_versions),
        screening: study.screening.clone(),
        report,
        blocks_with_excluded: with_excluded,
        scale_with_excluded,
        excluded,
        stimuli: stimuli.into_iter().map(stimulus).collect(),
        shown,
        devices,
        other_versions,
        chain: Chain {
            rows: chain.rows,
            head: chain.head,
            faults: chain.faults.into_iter().map(fault).collect(),
            blanked: chain.blanked,
        },
        paper: taylor_cameron().ok().filter(|_| study.id == PAPER_STUDY),
        design: study.clone(),
    })
}

/// With which devices those who are judged took part.
async fn devices(
    store: &Store,
    selection: &Selection,
    judged: &Judged<'_>,
) -> Result<Vec<DeviceCount>, StoreError> {
    let of: HashSet<&str> = judged.judged.iter().map(|participant| &*participant.session_id).collect();
    let id = &selection.study.id;
    let mut rates = BTreeMap::new();
    for told in store.shown_sizes(id, &selection.versions).await? {
        rates.entry(told.session_id).or_insert(told.refresh_hz);
    }
    let sessions = store.sessions(id, &selection.versions).await?;
    let known: Vec<ParticipantColumns> = sessions
        .iter()
        .filter(|session| of.contains(session.session_id.as_str()))
        .map(|session| ParticipantColumns {
            refresh_hz: rates.get(&session.session_id).copied().flatten(),
            ..of_session(session)
        })
        .collect();
    Ok(DeviceCount::of(&known))
}

/// In which sizes those who are judged saw the stimuli.
async fn shown_at(
    store: &Store,
    selection: &Selection,
    judged: &Judged<'_>,
) -> Result<Vec<ShownAt>, StoreError> {
    let of: HashSet<&str> = judged.judged.iter().map(|participant| &*participant.session_id).collect();
    let mut sizes = BTreeMap::<[u32; 2], ShownAt>::new();
    for told in store.shown_sizes(&selection.study.id, &selection.versions).await? {
        if !of.contains(told.session_id.as_str()) {
            continue;
        }
        let ShownSize { size, answers, scale, css_width_px, .. } = told;
        let shown = ShownAt { size, answers, scale, css_width_px };
        let all = match sizes.remove(&size) {
            Some(before) => before.with(shown),
            None => shown,
        };
        sizes.insert(size, all);
    }
    Ok(sizes.into_values().collect())
}

fn fault(kelir_store::Fault { chain, seq, what, note }: kelir_store::Fault) -> Fault {
    Fault { chain, seq, what, note }
}

/// Who is left out by the study's rules, and why.
fn excluded(judged: &Judged<'_>) -> Vec<Excluded> {
    let excluded = judged.left_out.iter().filter_map(|(visit, why)| match why {
        LeftOut::Excluded(reasons) => {
            Some(Excluded::new(&visit.session_id, reasons.clone(), visit.completed_us.is_some()))
        }
        _ => None,
    });
    excluded.collect()
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
    /// The versions cannot be chosen.
    #[error(transparent)]
    Selection(#[from] SelectionError),
    /// The data cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The full report of chosen versions of a study, from a data folder; a server may be using it at the same time.
///
/// # Errors
/// There is no such data folder, study or version, or it cannot be read.
pub async fn report_of_study(
    data: &Path,
    study: &str,
    version: &VersionRef,
    with: &With,
) -> Result<StudyReport, ResultsError> {
    let store = open_study(data, study).await?;
    let report = match Selection::of(&store, study, None, version, with).await {
        Ok(selection) => report(&store, &selection).await.map_err(ResultsError::from),
        Err(error) => Err(error.into()),
    };
    store.close().await;
    report
}

/// The store of a data folder that a study was served from.
///
/// # Errors
/// There is no such data folder or study, or it cannot be read.
pub async fn open_study(data: &Path, study: &str) -> Result<Store, ResultsError> {
    if !data.join("kelir.sqlite").is_file() {
        return Err(ResultsError::NoData(data.to_owned()));
    }
    let store = Store::open(data).await?;
    let known = store.study_ids().await?;
    if known.iter().any(|known| known == study) {
        return Ok(store);
    }
    store.close().await;
    Err(ResultsError::UnknownStudy { study: study.to_owned(), known })
}
