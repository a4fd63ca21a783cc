//! Participants' sessions: taking a slot, consenting, being seen, finishing.

use crate::clock;
use crate::error::StoreError;
use crate::sqlite::Store;
use kelir_study::plan::lowest_free_slot;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use std::time::Duration;

/// What is known of someone who begins.
#[derive(Clone, Debug)]
pub struct NewSession {
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub config_hash: String,
    /// Whose session: the panel's id for the participant, or the session's own id.
    pub subject_id: Option<String>,
    /// SHA-256 of the token that the browser holds.
    pub token_hash: String,
    /// Parameters of the address.
    pub params: Value,
    /// What the browser said about its display.
    pub display: Value,
    /// A session not seen for this long no longer holds its slot.
    pub idle: Duration,
}

/// The plan of one slot with the stimuli filled in.
#[derive(Clone, Debug)]
pub struct PlannedSession {
    /// Seed of the plan.
    pub seed: String,
    /// The trials in order.
    pub trials: Vec<PlannedTrial>,
}

/// One trial of a session: what is shown where.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlannedTrial {
    /// The trial as the study plans it.
    #[serde(flatten)]
    pub trial: kelir_study::Trial,
    /// Hash of the stimulus on the left.
    pub left_sha256: String,
    /// Hash of the stimulus on the right.
    pub right_sha256: String,
}

/// A session as stored.
#[derive(Clone, Debug)]
pub struct Session {
    /// Id (UUID v7).
    pub session_id: String,
    /// Study's id.
    pub study_id: String,
    /// Version of the study.
    pub config_hash: String,
    /// Whose session.
    pub subject_id: String,
    /// SHA-256 of the browser's token.
    pub token_hash: String,
    /// Place in the design.
    pub slot: u32,
    /// Seed of the plan.
    pub plan_seed: String,
    /// The trials in order.
    pub trials: Vec<PlannedTrial>,
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
    /// When it was finished.
    pub completed_at: Option<String>,
    /// The code given at the end.
    pub completion_code: Option<String>,
}

/// Outcome of finishing a session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Completed {
    /// Every trial is stored; this is the session's code, the same each time.
    Code(String),
    /// These trials have no answer yet.
    Missing(Vec<u32>),
}

/// How many people take part in one version of a study.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Participants {
    /// Sessions ever begun.
    pub started: u64,
    /// Not finished, and seen within the idle time.
    pub in_progress: u64,
    /// Finished.
    pub completed: u64,
}

impl Store {
    /// Begins a session in the lowest slot that no completed or active session of this version holds. `plan` is asked for
    /// that slot's plan while the slot is held, so two newcomers never get the same.
    pub async fn create_session(
        &self,
        new: NewSession,
        plan: impl FnOnce(u32) -> PlannedSession,
    ) -> Result<Session, StoreError> {
        let mut tx = self.writer.begin_with("BEGIN IMMEDIATE").await?;
        let held: Vec<u32> = sqlx::query_scalar(
            "SELECT slot FROM sessions WHERE study_id = $1 AND config_hash = $2
             AND (completed_at IS NOT NULL OR last_seen_at > $3)",
        )
        .bind(&new.study_id)
        .bind(&new.config_hash)
        .bind(clock::before_now(new.idle))
        .fetch_all(&mut *tx)
        .await?;
        let slot = lowest_free_slot(held);
        let planned = plan(slot);
        let session_id = uuid::Uuid::now_v7().to_string();
        let now = clock::now();
        let session = Session {
            subject_id: new.subject_id.unwrap_or_else(|| session_id.clone()),
            session_id,
            study_id: new.study_id,
            config_hash: new.config_hash,
            token_hash: new.token_hash,
            slot,
            plan_seed: planned.seed,
            trials: planned.trials,
            params: new.params,
            display: new.display,
            created_at: now.clone(),
            last_seen_at: now,
            consented_at: None,
            completed_at: None,
            completion_code: None,
        };
        insert_session(&mut tx, &session).await?;
        tx.commit().await?;
        Ok(session)
    }

    /// The session with this id.
    pub async fn session(&self, session_id: &str) -> Result<Option<Session>, StoreError> {
        let row = sqlx::query("SELECT * FROM sessions WHERE session_id = $1")
            .bind(session_id)
            .fetch_optional(&self.reader)
            .await?;
        row.as_ref().map(read_session).transpose()
    }

    /// All sessions of a study's version, oldest first.
    pub async fn sessions(&self, study_id: &str, config_hash: &str) -> Result<Vec<Session>, StoreError> {
        let rows = sqlx::query(
            "SELECT * FROM sessions WHERE study_id = $1 AND config_hash = $2 ORDER BY session_id",
        )
        .bind(study_id)
        .bind(config_hash)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(read_session).collect()
    }

    /// Notes that the session is alive, which keeps its slot.
    pub async fn touch_session(&self, session_id: &str) -> Result<(), StoreError> {
        sqlx::query("UPDATE sessions SET last_seen_at = $2 WHERE session_id = $1")
            .bind(session_id)
            .bind(clock::now())
            .execute(&self.writer)
            .await?;
        Ok(())
    }

    /// Notes that the participant agreed; the first time counts.
    pub async fn consent(&self, session_id: &str) -> Result<(), StoreError> {
        sqlx::query(
            "UPDATE sessions SET consented_at = COALESCE(consented_at, $2), last_seen_at = $2 WHERE session_id = $1",
        )
        .bind(session_id)
        .bind(clock::now())
        .execute(&self.writer)
        .await?;
        Ok(())
    }

    /// Indices of the trials that have an answer, ascending.
    pub async fn answered(&self, session_id: &str) -> Result<Vec<u32>, StoreError> {
        Ok(sqlx::query_scalar("SELECT trial_index FROM responses WHERE session_id = $1 ORDER BY trial_index")
            .bind(session_id)
            .fetch_all(&self.reader)
            .await?)
    }

    /// Finishes a session whose every trial is stored and gives it `code`; a session that is finished keeps its first code.
    pub async fn complete(&self, session: &Session, code: &str) -> Result<Completed, StoreError> {
        let mut tx = self.writer.begin_with("BEGIN IMMEDIATE").await?;
        let answered: Vec<u32> =
            sqlx::query_scalar("SELECT trial_index FROM responses WHERE session_id = $1")
                .bind(&session.session_id)
                .fetch_all(&mut *tx)
                .await?;
        let missing: Vec<u32> =
            (0..session.trials.len() as u32).filter(|index| !answered.contains(index)).collect();
        if !missing.is_empty() {
            return Ok(Completed::Missing(missing));
        }
        let code = sqlx::query_scalar(
            "UPDATE sessions SET completion_code = COALESCE(completion_code, $2), completed_at = COALESCE(completed_at, $3),
             last_seen_at = $3 WHERE session_id = $1 RETURNING completion_code",
        )
        .bind(&session.session_id)
        .bind(code)
        .bind(clock::now())
        .fetch_one(&mut *tx)
        .await?;
        tx.commit().await?;
        Ok(Completed::Code(code))
    }

    /// How many people take part in this version; `idle` as for [`NewSession`].
    pub async fn participants(
        &self,
        study_id: &str,
        config_hash: &str,
        idle: Duration,
    ) -> Result<Participants, StoreError> {
        let row = sqlx::query(
            "SELECT count(*) AS started, count(completed_at) AS completed,
             count(CASE WHEN completed_at IS NULL AND last_seen_at > $3 THEN 1 END) AS in_progress
             FROM sessions WHERE study_id = $1 AND config_hash = $2",
        )
        .bind(study_id)
        .bind(config_hash)
        .bind(clock::before_now(idle))
        .fetch_one(&self.reader)
        .await?;
        let count = |column| row.try_get::<i64, _>(column).map(|n| n as u64);
        Ok(Participants {
            started: count("started")?,
            in_progress: count("in_progress")?,
            completed: count("completed")?,
        })
    }

    /// When the first and the last answer to a study's version came, ISO-8601 UTC; `None` without answers.
    pub async fn answer_times(
        &self,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Option<(String, String)>, StoreError> {
        // Answers stand in the order they came: either end is found by walking in from it.
        let end = async |order: &str| -> Result<Option<String>, StoreError> {
            let query = format!(
                "SELECT r.received_at FROM responses r CROSS JOIN sessions s WHERE s.session_id = r.session_id
                 AND s.study_id = $1 AND s.config_hash = $2 ORDER BY r.response_id {order} LIMIT 1"
            );
            let row = sqlx::query_scalar(sqlx::AssertSqlSafe(query)).bind(study_id).bind(config_hash);
            Ok(row.fetch_optional(&self.reader).await?)
        };
        Ok(end("ASC").await?.zip(end("DESC").await?))
    }

    /// Number of sessions of each version of a study, `(config_hash, sessions)`.
    pub async fn sessions_by_version(&self, study_id: &str) -> Result<Vec<(String, u64)>, StoreError> {
        let rows = sqlx::query(
            "SELECT config_hash, count(*) AS n FROM sessions WHERE study_id = $1 GROUP BY config_hash",
        )
        .bind(study_id)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(|row| Ok((row.try_get("config_hash")?, row.try_get::<i64, _>("n")? as u64))).collect()
    }
}

pub(crate) async fn insert_session(
    writer: &mut SqliteConnection,
    session: &Session,
) -> Result<(), StoreError> {
    let trials = serde_json::to_string(&session.trials).map_err(|e| StoreError::corrupt("trials", e))?;
    sqlx::query(
        "INSERT INTO sessions (session_id, study_id, config_hash, subject_id, token_hash, slot, plan_seed, trials,
         trial_count, params, display, created_at, last_seen_at, consented_at, completed_at, completion_code)
         VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16)",
    )
    .bind(&session.session_id)
    .bind(&session.study_id)
    .bind(&session.config_hash)
    .bind(&session.subject_id)
    .bind(&session.token_hash)
    .bind(session.slot)
    .bind(&session.plan_seed)
    .bind(trials)
    .bind(session.trials.len() as i64)
    .bind(session.params.to_string())
    .bind(session.display.to_string())
    .bind(&session.created_at)
    .bind(&session.last_seen_at)
    .bind(&session.consented_at)
    .bind(&session.completed_at)
    .bind(&session.completion_code)
    .execute(writer)
    .await?;
    Ok(())
}

fn read_session(row: &SqliteRow) -> Result<Session, StoreError> {
    let json = |column: &'static str| -> Result<Value, StoreError> {
        let text: String = row.try_get(column)?;
        serde_json::from_str(&text).map_err(|e| StoreError::corrupt(column, e))
    };
    let trials = serde_json::from_value(json("trials")?).map_err(|e| StoreError::corrupt("trials", e))?;
    Ok(Session {
        session_id: row.try_get("session_id")?,
        study_id: row.try_get("study_id")?,
        config_hash: row.try_get("config_hash")?,
        subject_id: row.try_get("subject_id")?,
        token_hash: row.try_get("token_hash")?,
        slot: row.try_get("slot")?,
        plan_seed: row.try_get("plan_seed")?,
        trials,
        params: json("params")?,
        display: json("display")?,
        created_at: row.try_get("created_at")?,
        last_seen_at: row.try_get("last_seen_at")?,
        consented_at: row.try_get("consented_at")?,
        completed_at: row.try_get("completed_at")?,
        completion_code: row.try_get("completion_code")?,
    })
}
