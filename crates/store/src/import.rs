//! Sessions that were taken elsewhere or never, brought in many at a time: simulated ones for benchmarks.

use crate::answers::{Head, NewAnswer};
use crate::clock;
use crate::error::StoreError;
use crate::plans::{PlannedSession, insert_trials};
use crate::session_row::{Session, insert_session};
use crate::sqlite::Store;
use rusqlite::Connection;
use serde_json::json;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A session with all its answers.
#[derive(Clone, Debug)]
pub struct ImportedSession {
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub version: String,
    /// The study's file.
    pub file_hash: String,
    /// Place in the design.
    pub slot: u32,
    /// The trials it had.
    pub planned: PlannedSession,
    /// The answers in the order they came; one whose trial the session does not have is an error.
    pub answers: Vec<NewAnswer>,
    /// The code given at the end; absent: it was not finished.
    pub completion_code: Option<String>,
}

impl Store {
    /// Brings sessions in, all or none: through the same chain, rows and checks as answers that come one by one, but in one
    /// transaction.
    ///
    /// # Errors
    /// The database refuses, or an answer has no trial; nothing is stored.
    pub async fn import_sessions(&self, sessions: Vec<ImportedSession>) -> Result<(), StoreError> {
        self.write(move |writer| import(writer, sessions)).await
    }
}

fn import(writer: &Connection, sessions: Vec<ImportedSession>) -> Result<(), StoreError> {
    let mut chains = HashMap::<String, Head>::new();
    for imported in sessions {
        let session_id = uuid::Uuid::now_v7().to_string();
        let now = clock::now();
        let session = Session {
            subject_id: session_id.clone(),
            session_id,
            study_id: imported.study_id,
            version: imported.version,
            file_hash: imported.file_hash,
            token_hash: String::new(),
            kind: Default::default(),
            flags: Vec::new(),
            start_key: None,
            user_agent: None,
            slot: imported.slot,
            plan_seed: imported.planned.seed,
            more: imported.planned.next.more,
            params: json!({}),
            display: json!({}),
            created_at: now.clone(),
            last_seen_at: now.clone(),
            consented_at: Some(now.clone()),
            consent_sha256: None,
            completed_at: imported.completion_code.as_ref().map(|_| now.clone()),
            completion_code: imported.completion_code,
        };
        insert_session(writer, &session)?;
        let trials = &imported.planned.next.trials;
        insert_trials(writer, &session.session_id, trials, &now, 0)?;
        let chain = match chains.entry(session.study_id.clone()) {
            Entry::Occupied(chain) => chain.into_mut(),
            Entry::Vacant(place) => place.insert(Head::read(writer, &session.study_id)?),
        };
        for answer in &imported.answers {
            let planned = trials
                .get(answer.trial_index as usize)
                .ok_or_else(|| StoreError::corrupt("import", "an answer to a trial that is not planned"))?;
            chain.append(writer, &session, planned, answer, &now)?;
        }
    }
    Ok(())
}
