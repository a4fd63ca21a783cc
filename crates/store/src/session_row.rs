//! A session and its row.

use crate::error::StoreError;
use kelir_study::Repeat;
use rusqlite::{Connection, params};
use serde_json::{Value, json};
use std::time::Duration;

pub use kelir_study::visits::SessionKind;

/// The columns of a session's row, in the order in which they are read and written.
macro_rules! session_columns {
    () => {
        "session_id, study_id, version, file_hash, subject_id, token_hash, slot, plan_seed, more, params, display, created_at, last_seen_at, \
         consented_at, consent_sha256, completed_at, completion_code, kind, flags, start_key, user_agent"
    };
}
pub(crate) use session_columns;

/// What is known of someone who begins.
#[derive(Clone, Debug)]
pub struct NewSession {
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub version: String,
    /// The study's file, with the texts that are read.
    pub file_hash: String,
    /// Whose session: the panel's id for the participant, or the session's own id.
    pub subject_id: Option<String>,
    /// SHA-256 of the token that the browser holds.
    pub token_hash: String,
    /// Whose it is.
    pub kind: SessionKind,
    /// What was noticed when it began, in words such as `repeated_id`.
    pub flags: Vec<String>,
    /// What happens where the same person has a session of the study already.
    pub repeat: Repeat,
    /// The browser's own key of its wish to begin, the same when it asks again.
    pub start_key: Option<String>,
    /// What the browser calls itself.
    pub user_agent: Option<String>,
    /// Parameters of the address.
    pub params: Value,
    /// What the browser said about its display.
    pub display: Value,
    /// A session not seen for this long no longer holds its slot.
    pub idle: Duration,
}

/// A session as stored.
#[derive(Clone, Debug)]
pub struct Session {
    /// Id (UUID v7).
    pub session_id: String,
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub version: String,
    /// The study's file that it began with.
    pub file_hash: String,
    /// Whose session.
    pub subject_id: String,
    /// SHA-256 of the browser's token.
    pub token_hash: String,
    /// Place in the design.
    pub slot: u32,
    /// Seed of the plan.
    pub plan_seed: String,
    /// Whether answers will decide more trials than there are now.
    pub more: bool,
    /// Whose it is.
    pub kind: SessionKind,
    /// What was noticed when it began.
    pub flags: Vec<String>,
    /// The browser's own key of its wish to begin.
    pub start_key: Option<String>,
    /// What the browser calls itself.
    pub user_agent: Option<String>,
    /// Parameters of the address.
    pub params: Value,
    /// What the browser said about its display.
    pub display: Value,
    /// When it began, ISO-8601 UTC.
    pub created_at: String,
    /// When it was last heard of.
    pub last_seen_at: String,
    /// When consent was given.
    pub consented_at: Option<String>,
    /// SHA-256 of the text that was agreed to.
    pub consent_sha256: Option<String>,
    /// When it was finished.
    pub completed_at: Option<String>,
    /// The code given at the end.
    pub completion_code: Option<String>,
}

pub(crate) fn insert_session(writer: &Connection, session: &Session) -> Result<(), StoreError> {
    let mut insert = writer.prepare_cached(concat!(
        "INSERT INTO sessions (",
        session_columns!(),
        ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17, ?18, ?19, ?20, ?21)"
    ))?;
    insert.execute(params![
        session.session_id,
        session.study_id,
        session.version,
        session.file_hash,
        session.subject_id,
        session.token_hash,
        session.slot,
        session.plan_seed,
        session.more,
        session.params.to_string(),
        session.display.to_string(),
        session.created_at,
        session.last_seen_at,
        session.consented_at,
        session.consent_sha256,
        session.completed_at,
        session.completion_code,
        session.kind.as_str(),
        json!(session.flags).to_string(),
        session.start_key,
        session.user_agent,
    ])?;
    Ok(())
}

/// The session with this id, as it stands in this transaction.
pub(crate) fn session(connection: &Connection, session_id: &str) -> Result<Option<Session>, StoreError> {
    let mut query = connection.prepare_cached(concat!(
        "SELECT ",
        session_columns!(),
        " FROM sessions WHERE session_id = ?1"
    ))?;
    let mut rows = query.query([session_id])?;
    rows.next()?.map(read_session).transpose()
}

/// A session's row as `session_columns!` has it, read by place: finding 21 names would cost the writer more than the row itself.
pub(crate) fn read_session(row: &rusqlite::Row<'_>) -> Result<Session, StoreError> {
    fn json<T: serde::de::DeserializeOwned>(
        row: &rusqlite::Row<'_>,
        place: usize,
        name: &'static str,
    ) -> Result<T, StoreError> {
        let text = row.get_ref(place)?.as_str().map_err(rusqlite::Error::from)?;
        serde_json::from_str(text).map_err(|e| StoreError::corrupt(name, e))
    }
    Ok(Session {
        session_id: row.get(0)?,
        study_id: row.get(1)?,
        version: row.get(2)?,
        file_hash: row.get(3)?,
        subject_id: row.get(4)?,
        token_hash: row.get(5)?,
        slot: row.get(6)?,
        plan_seed: row.get(7)?,
        more: row.get(8)?,
        params: json(row, 9, "params")?,
        display: json(row, 10, "display")?,
        created_at: row.get(11)?,
        last_seen_at: row.get(12)?,
        consented_at: row.get(13)?,
        consent_sha256: row.get(14)?,
        completed_at: row.get(15)?,
        completion_code: row.get(16)?,
        kind: serde_json::from_value(Value::String(row.get(17)?))
            .map_err(|e| StoreError::corrupt("kind", e))?,
        flags: json(row, 18, "flags")?,
        start_key: row.get(19)?,
        user_agent: row.get(20)?,
    })
}
