//! Sessions that were taken elsewhere or never, brought in many at a time: simulated ones for benchmarks.

use crate::clock;
use crate::error::StoreError;
use crate::responses::{Head, NewResponse};
use crate::sessions::{PlannedSession, Session, insert_session};
use crate::sqlite::Store;
use serde_json::json;

/// A session with all its answers.
#[derive(Clone, Debug)]
pub struct ImportedSession {
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub config_hash: String,
    /// Place in the design.
    pub slot: u32,
    /// The trials it had.
    pub planned: PlannedSession,
    /// The answers in the order they came; one whose trial the session does not have is an error.
    pub answers: Vec<NewResponse>,
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
        let mut tx = self.writer.begin_with("BEGIN IMMEDIATE").await?;
        let mut chain = Head::read(&mut tx).await?;
        for imported in sessions {
            let session_id = uuid::Uuid::now_v7().to_string();
            let now = clock::now();
            let session = Session {
                subject_id: session_id.clone(),
                session_id,
                study_id: imported.study_id,
                config_hash: imported.config_hash,
                token_hash: String::new(),
                slot: imported.slot,
                plan_seed: imported.planned.seed,
                trials: imported.planned.trials,
                params: json!({}),
                display: json!({}),
                created_at: now.clone(),
                last_seen_at: now.clone(),
                consented_at: Some(now.clone()),
                completed_at: imported.completion_code.as_ref().map(|_| now.clone()),
                completion_code: imported.completion_code,
            };
            insert_session(&mut tx, &session).await?;
            for answer in &imported.answers {
                let planned = session.trials.get(answer.trial_index as usize).ok_or_else(|| {
                    StoreError::corrupt("import", "an answer to a trial that is not planned")
                })?;
                chain.append(&mut tx, &session, planned, answer, &now).await?;
            }
        }
        tx.commit().await?;
        Ok(())
    }
}
