//! A row of answers: as it is stored and hashed, and as it is read.

use crate::error::StoreError;
use kelir_study::trials::Role;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::collections::BTreeMap;

/// One stimulus of a trial.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShownStimulus {
    /// Item's id.
    pub item: String,
    /// Condition's name.
    pub condition: String,
    /// Hash of the file.
    pub sha256: String,
    /// Hash of its decoded pixels.
    pub pixels_sha256: String,
}

/// An answer as stored.
#[derive(Clone, Debug, PartialEq)]
pub struct AnswerRow {
    /// Version of the chain that it is part of: 1 (all studies in one, closed) or 2 (one a study).
    pub chain: u32,
    /// Place in its chain, from 1.
    pub seq: i64,
    /// Session's id.
    pub session_id: String,
    /// Whose session.
    pub subject_id: String,
    /// 0-based place in the session.
    pub trial_index: u32,
    /// Kind of the trial.
    pub trial_kind: String,
    /// What it showed.
    pub shown: BTreeMap<Role, ShownStimulus>,
    /// When the server committed it, ISO-8601 UTC.
    pub received_at: String,
    /// What was answered, as canonical JSON; `None` once withdrawn.
    pub answer: Option<String>,
    /// What the chain holds of answer and payload: of version 1 the payload's SHA-256, of version 2 that of nonce, answer and payload.
    pub answer_hash: String,
    /// Everything that the page sent; `None` once withdrawn.
    pub payload: Option<String>,
}

/// A row as it is stored and hashed: (study, seq, session, trial_index, trial_kind, shown, received_at, answer_hash, prev_hash).
pub(crate) type RowValues<T> = (String, i64, String, u32, String, T, String, String, String);

/// SHA-256 (hex) over nonce, answer, line feed and payload.
pub(crate) fn answer_hash(nonce: &[u8], answer: &[u8], payload: &[u8]) -> String {
    let parts = [nonce, answer, b"\n", payload];
    let hasher = parts.into_iter().fold(Sha256::new(), |hasher, part| hasher.chain_update(part));
    hex::encode(hasher.finalize())
}

/// A row of `answers` with its subject and what lies beside it.
pub(crate) fn read_answer(row: &SqliteRow) -> Result<AnswerRow, StoreError> {
    let values: RowValues<BTreeMap<Role, ShownStimulus>> =
        serde_json::from_str(row.try_get("row")?).map_err(|error| StoreError::corrupt("answer", error))?;
    let (_, seq, session_id, trial_index, trial_kind, shown, received_at, answer_hash, _) = values;
    Ok(AnswerRow {
        chain: 2,
        seq,
        session_id,
        subject_id: row.try_get("subject_id")?,
        trial_index,
        trial_kind,
        shown,
        received_at,
        answer: row.try_get("answer")?,
        answer_hash,
        payload: row.try_get("payload")?,
    })
}
