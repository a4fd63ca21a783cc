//! What happened to participants' pages, as a table: one row an event.

use crate::selection::Selection;
use crate::table::Table;
use kelir_store::{Store, StoreError};
use kelir_study::columns::{EventSession, event_rows, events_codebook};
use serde_json::Value;
use std::collections::HashMap;

/// One row for each thing that happened to a page while a trial of the chosen versions was taken, in the order of the answers.
///
/// # Errors
/// The store cannot be read.
pub async fn events_table(store: &Store, selection: &Selection) -> Result<Table, StoreError> {
    let study_id = &selection.study.id;
    let mut sessions = HashMap::new();
    for session in store.sessions(study_id, &selection.versions).await? {
        let trials = store.trials(&session.session_id).await?;
        sessions.insert(session.session_id.clone(), (session, trials));
    }
    let mut rows = Vec::new();
    for row in store.answer_rows(study_id, &selection.versions).await? {
        let Some((session, trials)) = sessions.get(&row.session_id) else { continue };
        let Some(planned) = trials.get(row.trial_index as usize) else { continue };
        let payload = row.payload.as_deref().and_then(|payload| serde_json::from_str(payload).ok());
        let of = EventSession {
            subject_id: &session.subject_id,
            session_id: &session.session_id,
            study_id,
            version: &session.version,
        };
        rows.extend(event_rows(&of, &planned.trial, &payload.unwrap_or(Value::Null)));
    }
    Ok(Table { name: "events", columns: events_codebook(), rows })
}
