//! Participants' sessions: taking a slot, consenting, being seen, finishing.

use crate::clock;
use crate::error::StoreError;
use crate::persons::{Begun, settle};
use crate::plans::{PlannedSession, forget_trials, insert_trials};
use crate::session_row::{NewSession, Session, insert_session, read_session, session, session_columns};
use crate::slots::Slots;
use crate::sqlite::Store;
use crate::writer::Refused;
use kelir_study::visits::SessionKind;
use rusqlite::{Connection, params};
use serde::Serialize;
use std::time::Duration;
use utoipa::ToSchema;

/// Outcome of finishing a session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Completed {
    /// Every trial is stored; this is the session's code, the same each time.
    Code(String),
    /// These trials have no answer yet; or none is missing of those decided, and answers to come will decide more.
    Missing(Vec<u32>),
}

/// How many people take part in one version of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct Participants {
    /// Sessions ever begun.
    pub started: u64,
    /// Not finished, and seen within the idle time.
    pub in_progress: u64,
    /// Finished.
    pub completed: u64,
}

impl Store {
    /// Begins a session, unless the same person has one and the study's policy says otherwise, in the lowest slot that no participant's completed
    /// or active session of this version holds. `plan` is asked for
    /// that slot's plan while the slot is held, so two newcomers never get the same.
    ///
    /// # Errors
    /// The database fails, or `plan` does; nothing is stored.
    pub async fn create_session<E: From<StoreError> + Send + 'static>(
        &self,
        new: NewSession,
        plan: impl FnOnce(u32) -> Result<PlannedSession, E> + Send + 'static,
    ) -> Result<Begun, E> {
        self.write_or(move |writer| create(writer, new, plan)).await
    }

    /// The session with this id; `None` for an unknown one.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn session(&self, session_id: &str) -> Result<Option<Session>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| session(connection, &session_id)).await
    }

    /// All sessions of these versions of a study, oldest first.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn sessions(&self, study_id: &str, versions: &[String]) -> Result<Vec<Session>, StoreError> {
        let versions = serde_json::to_string(versions).map_err(|e| StoreError::corrupt("versions", e))?;
        let study_id = study_id.to_owned();
        self.readers
            .read(move |connection| {
                let mut query = connection.prepare_cached(concat!(
                    "SELECT ",
                    session_columns!(),
                    " FROM sessions WHERE study_id = ?1 AND version IN (SELECT value FROM json_each(?2)) ORDER BY session_id"
                ))?;
                let mut rows = query.query([study_id, versions])?;
                let mut sessions = Vec::new();
                while let Some(row) = rows.next()? {
                    sessions.push(read_session(row)?);
                }
                Ok(sessions)
            })
            .await
    }

    /// Notes that the session is alive, which keeps its slot, whoever else has it.
    ///
    /// # Errors
    /// The database fails.
    pub async fn touch_session(&self, session_id: &str) -> Result<(), StoreError> {
        let session_id = session_id.to_owned();
        self.write(move |writer| {
            let mut seen =
                writer.prepare_cached("UPDATE sessions SET last_seen_at = ?2 WHERE session_id = ?1")?;
            seen.execute(params![session_id, clock::now()])?;
            Ok(())
        })
        .await
    }

    /// Takes a session up again. Who has answered nothing and was silent for so long that somebody else has their slot gets a new one, with the
    /// plan that `plan` has for it; any other keeps its own.
    ///
    /// # Errors
    /// The database fails or has no such session, or `plan` fails; nothing is stored.
    pub async fn resume<E: From<StoreError> + Send + 'static>(
        &self,
        session: &Session,
        idle: Duration,
        plan: impl FnOnce(u32) -> Result<PlannedSession, E> + Send + 'static,
    ) -> Result<Session, E> {
        let session_id = session.session_id.clone();
        self.write_or(move |writer| come_back(writer, &session_id, None, idle, plan)).await
    }

    /// Notes that the participant agreed to the text of this hash; the first time counts. Otherwise as [`Store::resume`].
    ///
    /// # Errors
    /// The database fails or has no such session, or `plan` fails; nothing is stored.
    pub async fn consent<E: From<StoreError> + Send + 'static>(
        &self,
        session: &Session,
        consent_sha256: &str,
        idle: Duration,
        plan: impl FnOnce(u32) -> Result<PlannedSession, E> + Send + 'static,
    ) -> Result<Session, E> {
        let (session_id, consent_sha256) = (session.session_id.clone(), consent_sha256.to_owned());
        self.write_or(move |writer| come_back(writer, &session_id, Some(consent_sha256), idle, plan)).await
    }

    /// Indices of the trials that have an answer, ascending.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn answered(&self, session_id: &str) -> Result<Vec<u32>, StoreError> {
        let session_id = session_id.to_owned();
        self.readers.read(move |connection| answered(connection, &session_id)).await
    }

    /// Finishes a session whose every trial is stored and gives it `code`; a session that is finished keeps its first code.
    ///
    /// # Errors
    /// The database fails, or has no such session.
    pub async fn complete(&self, session: &Session, code: &str) -> Result<Completed, StoreError> {
        let (session_id, code) = (session.session_id.clone(), code.to_owned());
        self.write(move |writer| complete(writer, &session_id, &code)).await
    }

    /// When the first and the last answer to these versions of a study came, ISO-8601 UTC; `None` without answers.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn answer_times(
        &self,
        study_id: &str,
        versions: &[String],
    ) -> Result<Option<(String, String)>, StoreError> {
        let versions = serde_json::to_string(versions).map_err(|e| StoreError::corrupt("versions", e))?;
        // Answers stand in the order they came: either end is found by walking in from it.
        let end = async |table: &str,
                         time: &str,
                         place: &str,
                         order: &str|
               -> Result<Option<String>, StoreError> {
            let query = format!(
                "SELECT {time} FROM {table} a CROSS JOIN sessions s WHERE s.session_id = a.session_id AND s.study_id = $1
                 AND s.version IN (SELECT value FROM json_each($2)) ORDER BY {place} {order} LIMIT 1"
            );
            let row = sqlx::query_scalar(sqlx::AssertSqlSafe(query)).bind(study_id).bind(&versions);
            Ok(row.fetch_optional(&self.reader).await?)
        };
        let first = ("responses", "a.received_at", "a.response_id");
        let second = ("answers", "json_extract(a.row, '$[6]')", "a.seq");
        let mut ends = [None, None];
        for (end_of, order) in ends.iter_mut().zip(["ASC", "DESC"]) {
            // The first chain is older than the second.
            for (table, time, place) in if order == "ASC" { [first, second] } else { [second, first] } {
                if end_of.is_none() {
                    *end_of = end(table, time, place, order).await?;
                }
            }
        }
        let [first, last] = ends;
        Ok(first.zip(last))
    }
}

fn create<E>(
    writer: &Connection,
    mut new: NewSession,
    plan: impl FnOnce(u32) -> Result<PlannedSession, E>,
) -> Result<Begun, Refused<E>> {
    if let Some(settled) = settle(writer, &mut new)? {
        return Ok(settled);
    }
    let slots = Slots { writer, study_id: &new.study_id, version: &new.version, idle: new.idle };
    let slot = slots.lowest_free()?;
    let planned = plan(slot).map_err(Refused::Caller)?;
    let now = clock::now();
    if new.kind == SessionKind::Participant {
        slots.take(slot, &now)?;
    }
    let session_id = uuid::Uuid::now_v7().to_string();
    let session = Session {
        subject_id: new.subject_id.unwrap_or_else(|| session_id.clone()),
        session_id,
        study_id: new.study_id,
        version: new.version,
        file_hash: new.file_hash,
        token_hash: new.token_hash,
        slot,
        plan_seed: planned.seed,
        more: planned.next.more,
        kind: new.kind,
        flags: new.flags,
        start_key: new.start_key,
        user_agent: new.user_agent,
        params: new.params,
        display: new.display,
        created_at: now.clone(),
        last_seen_at: now,
        consented_at: None,
        consent_sha256: None,
        completed_at: None,
        completion_code: None,
    };
    insert_session(writer, &session)?;
    insert_trials(writer, &session.session_id, &planned.next.trials, &session.created_at, 0)?;
    Ok(Begun::New(session))
}

/// Somebody is back, perhaps with consent to the text of a hash.
fn come_back<E>(
    writer: &Connection,
    session_id: &str,
    consent_sha256: Option<String>,
    idle: Duration,
    plan: impl FnOnce(u32) -> Result<PlannedSession, E>,
) -> Result<Session, Refused<E>> {
    let gone = || StoreError::corrupt("session", "there is none of this id");
    let mut known = session(writer, session_id)?.ok_or_else(gone)?;
    let now = clock::now();
    if known.kind == SessionKind::Participant && known.completed_at.is_none() {
        let slots = Slots { writer, study_id: &known.study_id, version: &known.version, idle };
        if slots.is_held_beside(known.slot, session_id)? && answered(writer, session_id)?.is_empty() {
            let slot = slots.lowest_free()?;
            let planned = plan(slot).map_err(Refused::Caller)?;
            slots.take(slot, &now)?;
            forget_trials(writer, session_id)?;
            insert_trials(writer, session_id, &planned.next.trials, &now, 0)?;
            (known.slot, known.plan_seed, known.more) = (slot, planned.seed, planned.next.more);
        }
    }
    if let Some(consent_sha256) = consent_sha256.filter(|_| known.consented_at.is_none()) {
        known.consented_at = Some(now.clone());
        known.consent_sha256 = Some(consent_sha256);
    }
    known.last_seen_at = now;
    let mut back = writer.prepare_cached(
        "UPDATE sessions SET slot = ?2, plan_seed = ?3, more = ?4, consented_at = ?5, consent_sha256 = ?6, last_seen_at = ?7
         WHERE session_id = ?1",
    )?;
    let Session { slot, plan_seed, more, consented_at, consent_sha256, last_seen_at, .. } = &known;
    back.execute(params![session_id, slot, plan_seed, more, consented_at, consent_sha256, last_seen_at])?;
    Ok(known)
}

fn complete(writer: &Connection, session_id: &str, code: &str) -> Result<Completed, StoreError> {
    let answered = answered(writer, session_id)?;
    let mut plan = writer.prepare_cached(
        "SELECT more, (SELECT count(*) FROM session_trials t WHERE t.session_id = s.session_id)
         FROM sessions s WHERE session_id = ?1",
    )?;
    let (more, trials): (bool, u32) = plan.query_row([session_id], |row| Ok((row.get(0)?, row.get(1)?)))?;
    let missing: Vec<u32> = (0..trials).filter(|index| !answered.contains(index)).collect();
    if more || !missing.is_empty() {
        return Ok(Completed::Missing(missing));
    }
    let mut complete = writer.prepare_cached(
        "UPDATE sessions SET completion_code = COALESCE(completion_code, ?2), completed_at = COALESCE(completed_at, ?3),
         last_seen_at = ?3 WHERE session_id = ?1 RETURNING completion_code",
    )?;
    Ok(Completed::Code(complete.query_row(params![session_id, code, clock::now()], |row| row.get(0))?))
}

/// Indices of the trials of a session that have an answer, ascending.
pub(crate) fn answered(connection: &Connection, session_id: &str) -> Result<Vec<u32>, StoreError> {
    let mut query = connection.prepare_cached(
        "SELECT trial_index FROM responses WHERE session_id = ?1
         UNION SELECT trial_index FROM answers WHERE session_id = ?1 ORDER BY trial_index",
    )?;
    Ok(query.query_map([session_id], |row| row.get(0))?.collect::<Result<_, _>>()?)
}
