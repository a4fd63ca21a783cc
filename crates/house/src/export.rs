//! Answers as a table: one tidy row a trial.

use crate::events::events_table;
use crate::participants::{participants_table, status, verdicts};
use crate::selection::Selection;
use crate::table::{Table, codebook_of};
use crate::versions::designs;
use crate::workbook::workbook;
use kelir_store::{PlannedTrial, Store, StoreError, sha256_hex};
use kelir_study::columns::{Answered, Rows, SessionColumns, codebook};
use serde_json::Value;
use std::collections::HashMap;

/// A session with its trials, and what its rows say of it.
struct Taken {
    columns: SessionColumns,
    trials: Vec<PlannedTrial>,
}

/// One row for each answer to the chosen versions, in the order they came.
///
/// # Errors
/// The store cannot be read.
pub async fn responses_csv(store: &Store, selection: &Selection) -> Result<String, StoreError> {
    Ok(responses_table(store, selection).await?.csv())
}

/// The same as a table.
///
/// # Errors
/// The store cannot be read.
pub async fn responses_table(store: &Store, selection: &Selection) -> Result<Table, StoreError> {
    let study = &selection.study;
    let rows = store.answer_rows(&study.id, &selection.versions).await?;
    let mut answered: HashMap<&str, usize> = HashMap::new();
    for row in &rows {
        *answered.entry(&row.session_id).or_default() += 1;
    }
    let (designs, verdicts) = (designs(store, &study.id).await?, verdicts(store, selection).await?);
    let mut sessions = HashMap::new();
    for session in store.sessions(&study.id, &selection.versions).await? {
        let trials = store.trials(&session.session_id).await?;
        let answers = answered.get(session.session_id.as_str()).copied().unwrap_or_default();
        let most = if session.more { study.most_trials() } else { trials.len() };
        let verdict = verdicts.get(&session.session_id).cloned().unwrap_or_default();
        let columns = SessionColumns {
            status: status(&session),
            judged: verdict.is_judged.into(),
            reject_reason: verdict.reason,
            subject_id: session.subject_id,
            session_id: session.session_id.clone(),
            study_id: session.study_id,
            config_hash: session.version.clone(),
            design_hash: designs.get(&session.version).cloned().unwrap_or_default(),
            version: session.version,
            percent_complete: 100.0 * answers as f64 / most.max(1) as f64,
            slot: session.slot,
            plan_seed: session.plan_seed,
        };
        sessions.insert(session.session_id, Taken { columns, trials });
    }
    let sizes = sizes(store, selection).await?;
    let table = Rows::default();
    let mut cells = Vec::with_capacity(rows.len());
    for row in &rows {
        let Some(taken) = sessions.get(&row.session_id) else { continue };
        let Some(planned) = taken.trials.get(row.trial_index as usize) else { continue };
        let payload = row.payload.as_deref().and_then(|payload| serde_json::from_str(payload).ok());
        cells.push(table.cells(&Answered {
            study,
            session: &taken.columns,
            trial: &planned.trial,
            sha256: row.shown.iter().map(|(role, shown)| (*role, shown.sha256.as_str())).collect(),
            size:
                row.shown.values().find_map(|shown| sizes.get(&shown.sha256).copied()).unwrap_or(study.size),
            answer: row.answer.as_deref().filter(|_| row.payload.is_some()),
            payload: &payload.unwrap_or(Value::Null),
            payload_hash: row.payload.as_ref().map(|payload| sha256_hex(payload.as_bytes())),
            answer_hash: &row.answer_hash,
            received_at: &row.received_at,
            place: (row.chain, row.seq),
        }));
    }
    Ok(Table { name: "responses", columns: codebook(), rows: cells })
}

/// The size of each stimulus of the chosen versions, by its hash; those that were never known are left out.
async fn sizes(store: &Store, selection: &Selection) -> Result<HashMap<String, [u32; 2]>, StoreError> {
    let mut sizes = HashMap::new();
    for version in &selection.versions {
        let stimuli = store.version_stimuli(&selection.study.id, version).await?;
        sizes.extend(stimuli.into_iter().filter(|s| s.size != [0, 0]).map(|s| (s.sha256, s.size)));
    }
    Ok(sizes)
}

/// Every table of the chosen versions as one spreadsheet.
///
/// # Errors
/// The store cannot be read, or the file cannot be put together.
pub async fn spreadsheet(store: &Store, selection: &Selection) -> Result<Vec<u8>, ExportError> {
    let tables = [
        responses_table(store, selection).await?,
        participants_table(store, selection).await?,
        events_table(store, selection).await?,
    ];
    workbook(&tables).map_err(|e| ExportError::Workbook(e.to_string()))
}

/// Why there is no spreadsheet.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The store cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The file cannot be put together.
    #[error("the spreadsheet cannot be written: {0}")]
    Workbook(String),
}

/// What each column of the table of responses is.
pub fn codebook_csv() -> String {
    codebook_of(&codebook()).csv()
}
