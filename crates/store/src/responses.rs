//! Answers: appended once, never changed.

use crate::chain::{ChainRow, GENESIS};
use crate::clock;
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::sessions::{PlannedTrial, Session};
use crate::sqlite::Store;
use serde::Serialize;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

/// An answer to one trial.
#[derive(Clone, Debug)]
pub struct NewResponse {
    /// Index of the trial in its session.
    pub trial_index: u32,
    /// Whether the left picture was chosen.
    pub chose_left: bool,
    /// Response time in ms, finite and not negative.
    pub rt_ms: f64,
    /// Everything that the browser sent, as JSON text.
    pub payload: String,
}

/// Outcome of storing an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Appended {
    /// Committed now.
    Stored,
    /// The same answer (choice and response time) was committed before.
    Same,
    /// Another answer was committed before; it stands.
    Different,
    /// The session has no trial of this index.
    NoSuchTrial,
}

/// An answer as stored.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResponseRow {
    /// Place in the chain, from 1.
    pub response_id: i64,
    /// Session's id.
    pub session_id: String,
    /// Whose session.
    pub subject_id: String,
    /// 0-based place in the session.
    pub trial_index: u32,
    /// Block's id.
    pub block_id: String,
    /// Pair's id.
    pub pair_id: String,
    /// Hash of the stimulus on the left.
    pub left_sha256: String,
    /// Hash of the stimulus on the right.
    pub right_sha256: String,
    /// Condition on the left.
    pub left_condition: String,
    /// Condition on the right.
    pub right_condition: String,
    /// `left` or `right`.
    pub choice: String,
    /// Condition chosen.
    pub chosen_condition: String,
    /// Response time in ms.
    pub rt_ms: f64,
    /// When the server committed it, ISO-8601 UTC.
    pub received_at: String,
    /// SHA-256 of the payload.
    pub payload_hash: String,
}

impl Store {
    /// Appends an answer. When it returns [`Appended::Stored`] or [`Appended::Same`], the answer is on disk.
    pub async fn append_response(&self, session: &Session, new: NewResponse) -> Result<Appended, StoreError> {
        let Some(planned) = session.trials.get(new.trial_index as usize) else {
            return Ok(Appended::NoSuchTrial);
        };
        let choice = choice(new.chose_left);
        let mut tx = self.writer.begin_with("BEGIN IMMEDIATE").await?;
        let stored =
            sqlx::query("SELECT choice, rt_ms FROM responses WHERE session_id = $1 AND trial_index = $2")
                .bind(&session.session_id)
                .bind(new.trial_index)
                .fetch_optional(&mut *tx)
                .await?;
        if let Some(stored) = stored {
            let same = stored.try_get::<&str, _>("choice")? == choice
                && stored.try_get::<f64, _>("rt_ms")? == new.rt_ms;
            return Ok(if same { Appended::Same } else { Appended::Different });
        }
        let mut chain = Head::read(&mut tx).await?;
        let now = clock::now();
        chain.append(&mut tx, session, planned, &new, &now).await?;
        sqlx::query("UPDATE sessions SET last_seen_at = $2 WHERE session_id = $1")
            .bind(&session.session_id)
            .bind(&now)
            .execute(&mut *tx)
            .await?;
        tx.commit().await?;
        Ok(Appended::Stored)
    }

    /// All answers to a study's version, in the order they came, each with its payload (absent once blanked).
    pub async fn responses(
        &self,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Vec<(ResponseRow, Option<String>)>, StoreError> {
        let rows = sqlx::query(
            "SELECT r.*, s.subject_id, p.payload FROM responses r JOIN sessions s USING (session_id)
             LEFT JOIN response_payloads p USING (response_id)
             WHERE s.study_id = $1 AND s.config_hash = $2 ORDER BY r.response_id",
        )
        .bind(study_id)
        .bind(config_hash)
        .fetch_all(&self.reader)
        .await?;
        rows.iter().map(|row| Ok((read_response(row)?, row.try_get("payload")?))).collect()
    }
}

fn choice(left: bool) -> &'static str {
    if left { "left" } else { "right" }
}

/// The end of the chain of answers, while its one writer holds it.
pub(crate) struct Head {
    response_id: i64,
    row_hash: String,
}

impl Head {
    /// The last row's.
    pub(crate) async fn read(writer: &mut SqliteConnection) -> Result<Head, StoreError> {
        let last =
            sqlx::query("SELECT response_id, row_hash FROM responses ORDER BY response_id DESC LIMIT 1")
                .fetch_optional(writer)
                .await?;
        Ok(match last {
            Some(row) => {
                Head { response_id: row.try_get("response_id")?, row_hash: row.try_get("row_hash")? }
            }
            None => Head { response_id: 0, row_hash: GENESIS.to_owned() },
        })
    }

    /// Writes the next row and its payload, and moves on to it.
    pub(crate) async fn append(
        &mut self,
        writer: &mut SqliteConnection,
        session: &Session,
        planned: &PlannedTrial,
        new: &NewResponse,
        now: &str,
    ) -> Result<(), StoreError> {
        let trial = &planned.trial;
        let row = ResponseRow {
            response_id: self.response_id + 1,
            session_id: session.session_id.clone(),
            subject_id: session.subject_id.clone(),
            trial_index: new.trial_index,
            block_id: trial.block_id.clone(),
            pair_id: trial.item_id.clone(),
            left_sha256: planned.left_sha256.clone(),
            right_sha256: planned.right_sha256.clone(),
            left_condition: trial.left.clone(),
            right_condition: trial.right.clone(),
            choice: choice(new.chose_left).to_owned(),
            chosen_condition: if new.chose_left { trial.left.clone() } else { trial.right.clone() },
            rt_ms: new.rt_ms,
            received_at: now.to_owned(),
            payload_hash: sha256_hex(new.payload.as_bytes()),
        };
        let row_hash = ChainRow { row: &row, prev_hash: &self.row_hash }.hash();
        sqlx::query(
            "INSERT INTO responses (response_id, session_id, trial_index, block_id, pair_id, left_sha256, right_sha256,
             left_condition, right_condition, choice, chosen_condition, rt_ms, received_at, payload_hash, prev_hash, row_hash)
             VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16)",
        )
        .bind(row.response_id)
        .bind(&row.session_id)
        .bind(row.trial_index)
        .bind(&row.block_id)
        .bind(&row.pair_id)
        .bind(&row.left_sha256)
        .bind(&row.right_sha256)
        .bind(&row.left_condition)
        .bind(&row.right_condition)
        .bind(&row.choice)
        .bind(&row.chosen_condition)
        .bind(row.rt_ms)
        .bind(&row.received_at)
        .bind(&row.payload_hash)
        .bind(&self.row_hash)
        .bind(&row_hash)
        .execute(&mut *writer)
        .await?;
        sqlx::query("INSERT INTO response_payloads (response_id, payload) VALUES ($1, $2)")
            .bind(row.response_id)
            .bind(&new.payload)
            .execute(&mut *writer)
            .await?;
        *self = Head { response_id: row.response_id, row_hash };
        Ok(())
    }
}

pub(crate) fn read_response(row: &SqliteRow) -> Result<ResponseRow, StoreError> {
    Ok(ResponseRow {
        response_id: row.try_get("response_id")?,
        session_id: row.try_get("session_id")?,
        subject_id: row.try_get("subject_id")?,
        trial_index: row.try_get("trial_index")?,
        block_id: row.try_get("block_id")?,
        pair_id: row.try_get("pair_id")?,
        left_sha256: row.try_get("left_sha256")?,
        right_sha256: row.try_get("right_sha256")?,
        left_condition: row.try_get("left_condition")?,
        right_condition: row.try_get("right_condition")?,
        choice: row.try_get("choice")?,
        chosen_condition: row.try_get("chosen_condition")?,
        rt_ms: row.try_get("rt_ms")?,
        received_at: row.try_get("received_at")?,
        payload_hash: row.try_get("payload_hash")?,
    })
}
