//! Answers: appended once, never changed.

use crate::clock;
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::first_chain::{self, GENESIS};
use crate::plans::{PlannedTrial, decided, insert_trials, trial};
use crate::sessions::Session;
use crate::sqlite::Store;
use kelir_study::trials::Role;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use std::collections::BTreeMap;

/// An answer to one trial.
#[derive(Clone, Debug)]
pub struct NewAnswer {
    /// Index of the trial in its session.
    pub trial_index: u32,
    /// What was answered, as canonical JSON.
    pub answer: String,
    /// Everything that the page sent, to the byte.
    pub payload: String,
}

/// Outcome of storing an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Appended {
    /// Committed now.
    Stored,
    /// The same bytes were committed before.
    Same,
    /// Other bytes were committed before; they stand. Boxed, for it is rare.
    Different(Box<StoredAnswer>),
    /// The session has no trial of this index.
    NoSuchTrial,
}

/// What stands where another answer came.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredAnswer {
    /// When it was committed, ISO-8601 UTC.
    pub received_at: String,
    /// What was answered; null once withdrawn.
    pub answer: Option<Value>,
    /// Everything that the page sent; null once withdrawn.
    pub payload: Option<Value>,
}

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

/// What a session has been shown and has answered, for whoever decides what comes next.
#[derive(Debug)]
pub struct Progress {
    /// The trials decided so far.
    pub trials: Vec<PlannedTrial>,
    /// Answers by trial index, as canonical JSON.
    pub answers: BTreeMap<u32, String>,
}

/// What comes next in a session.
#[derive(Clone, Debug, Default)]
pub struct NextTrials {
    /// The trials that follow those decided before.
    pub trials: Vec<PlannedTrial>,
    /// Whether answers will decide others.
    pub more: bool,
}

impl Store {
    /// Appends an answer, and the trials that follow from it, in one transaction: `next` is asked for them where the session's plan goes on.
    /// When it returns [`Appended::Stored`] or [`Appended::Same`], the answer is on disk.
    ///
    /// # Errors
    /// The database fails, or `next` does; nothing is stored.
    pub async fn append_answer<E: From<StoreError>>(
        &self,
        session: &Session,
        new: &NewAnswer,
        next: impl FnOnce(Progress) -> Result<NextTrials, E>,
    ) -> Result<Appended, E> {
        let mut tx = self.writer.begin_with("BEGIN IMMEDIATE").await.map_err(StoreError::from)?;
        if let Some(stored) = stored(&mut tx, &session.session_id, new).await? {
            return Ok(stored);
        }
        let Some(planned) = trial(&mut tx, &session.session_id, new.trial_index).await? else {
            return Ok(Appended::NoSuchTrial);
        };
        let mut chain = Head::read(&mut tx, &session.study_id).await?;
        let now = clock::now();
        chain.append(&mut tx, session, &planned, new, &now).await?;
        let mut more = more(&mut tx, &session.session_id).await?;
        if more {
            let trials = decided(&mut tx, &session.session_id, 0).await?;
            let answers = answers_of(&mut tx, &session.session_id).await?;
            let next = next(Progress { answers, trials })?;
            insert_trials(&mut tx, &session.session_id, &next.trials, &now, chain.seq).await?;
            more = next.more;
        }
        sqlx::query("UPDATE sessions SET last_seen_at = $2, more = $3 WHERE session_id = $1")
            .bind(&session.session_id)
            .bind(&now)
            .bind(more)
            .execute(&mut *tx)
            .await
            .map_err(StoreError::from)?;
        tx.commit().await.map_err(StoreError::from)?;
        Ok(Appended::Stored)
    }

    /// All answers to these versions of a study, in the order they came.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn answer_rows(
        &self,
        study_id: &str,
        versions: &[String],
    ) -> Result<Vec<AnswerRow>, StoreError> {
        let versions = serde_json::to_string(versions).map_err(|e| StoreError::corrupt("versions", e))?;
        const OF: &str = "s.study_id = $1 AND s.version IN (SELECT value FROM json_each($2))";
        let first = format!("{} WHERE {OF} ORDER BY r.response_id", first_chain::SELECT);
        let second = format!(
            "SELECT a.*, s.subject_id, c.answer, c.payload FROM answers a JOIN sessions s USING (session_id)
             LEFT JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq WHERE {OF} ORDER BY a.seq"
        );
        let mut rows = Vec::new();
        let queries = [(first, first_chain::read_answer as fn(&SqliteRow) -> _), (second, read_answer)];
        for (query, read) in queries {
            let query = sqlx::query(sqlx::AssertSqlSafe(query)).bind(study_id).bind(&versions);
            for row in query.fetch_all(&self.reader).await? {
                rows.push(read(&row)?);
            }
        }
        Ok(rows)
    }
}

/// Whether answers will decide more trials of this session.
async fn more(writer: &mut SqliteConnection, session_id: &str) -> Result<bool, StoreError> {
    let query = sqlx::query_scalar("SELECT more FROM sessions WHERE session_id = $1").bind(session_id);
    Ok(query.fetch_one(writer).await?)
}

/// What stands where `new` would go, if anything does.
async fn stored(
    writer: &mut SqliteConnection,
    session_id: &str,
    new: &NewAnswer,
) -> Result<Option<Appended>, StoreError> {
    let second = sqlx::query(
        "SELECT json_extract(a.row, '$[6]') AS received_at, c.answer, c.payload FROM answers a
         LEFT JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq
         WHERE a.session_id = $1 AND a.trial_index = $2",
    );
    let second = second.bind(session_id).bind(new.trial_index).fetch_optional(&mut *writer).await?;
    let json = |text: &Option<String>| text.as_ref().and_then(|text| serde_json::from_str(text).ok());
    if let Some(row) = second {
        let (answer, payload): (Option<String>, Option<String>) =
            (row.try_get("answer")?, row.try_get("payload")?);
        if payload.as_ref() == Some(&new.payload) {
            return Ok(Some(Appended::Same));
        }
        let received_at = row.try_get("received_at")?;
        let stored = StoredAnswer { received_at, answer: json(&answer), payload: json(&payload) };
        return Ok(Some(Appended::Different(Box::new(stored))));
    }
    let first = sqlx::query(
        "SELECT r.choice, r.rt_ms, r.received_at, p.payload FROM responses r LEFT JOIN response_payloads p USING (response_id)
         WHERE r.session_id = $1 AND r.trial_index = $2",
    );
    let first = first.bind(session_id).bind(new.trial_index).fetch_optional(writer).await?;
    first
        .map(|row| {
            let payload: Option<String> = row.try_get("payload")?;
            // Version 1 kept what came as its own JSON writer has it.
            let sent: Option<Value> = serde_json::from_str(&new.payload).ok();
            if payload.is_some() && payload == sent.map(|sent| sent.to_string()) {
                return Ok(Appended::Same);
            }
            let answer = Some(first_chain::answer(row.try_get("choice")?, row.try_get("rt_ms")?)?);
            let received_at = row.try_get("received_at")?;
            let stored = StoredAnswer { received_at, answer: json(&answer), payload: json(&payload) };
            Ok(Appended::Different(Box::new(stored)))
        })
        .transpose()
}

/// Every answer of a session by trial index, as canonical JSON; without those withdrawn.
async fn answers_of(
    connection: &mut SqliteConnection,
    session_id: &str,
) -> Result<BTreeMap<u32, String>, StoreError> {
    let mut answers = BTreeMap::new();
    let first = sqlx::query("SELECT trial_index, choice, rt_ms FROM responses WHERE session_id = $1");
    for row in first.bind(session_id).fetch_all(&mut *connection).await? {
        let answer = first_chain::answer(row.try_get("choice")?, row.try_get("rt_ms")?)?;
        answers.insert(row.try_get("trial_index")?, answer);
    }
    let second = sqlx::query(
        "SELECT a.trial_index, c.answer FROM answers a JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq
         WHERE a.session_id = $1 AND c.answer IS NOT NULL",
    );
    for row in second.bind(session_id).fetch_all(connection).await? {
        answers.insert(row.try_get("trial_index")?, row.try_get("answer")?);
    }
    Ok(answers)
}

/// The end of a study's chain of answers, while its one writer holds it.
pub(crate) struct Head {
    seq: i64,
    row_hash: String,
}

/// A row as it is stored and hashed: (study, seq, session, trial_index, trial_kind, shown, received_at, answer_hash, prev_hash).
pub(crate) type RowValues<T> = (String, i64, String, u32, String, T, String, String, String);

impl Head {
    /// The last row's; for a study without any, what its chain begins with.
    pub(crate) async fn read(writer: &mut SqliteConnection, study_id: &str) -> Result<Head, StoreError> {
        let last =
            sqlx::query("SELECT seq, row_hash FROM answers WHERE study_id = $1 ORDER BY seq DESC LIMIT 1")
                .bind(study_id)
                .fetch_optional(&mut *writer)
                .await?;
        Ok(match last {
            Some(row) => Head { seq: row.try_get("seq")?, row_hash: row.try_get("row_hash")? },
            None => Head { seq: 0, row_hash: genesis(writer).await? },
        })
    }

    /// Writes the next row and what it holds, and moves on to it.
    pub(crate) async fn append(
        &mut self,
        writer: &mut SqliteConnection,
        session: &Session,
        planned: &PlannedTrial,
        new: &NewAnswer,
        now: &str,
    ) -> Result<(), StoreError> {
        let mut nonce = [0; 16];
        getrandom::fill(&mut nonce).map_err(|error| StoreError::corrupt("nonce", error))?;
        let answer_hash = answer_hash(&nonce, new.answer.as_bytes(), new.payload.as_bytes());
        let seq = self.seq + 1;
        let values = json!([
            session.study_id,
            seq,
            session.session_id,
            new.trial_index,
            planned.trial.trial.name(),
            planned.shown()?,
            now,
            answer_hash,
            self.row_hash,
        ]);
        let row = kelir_jcs::canonical(values).map_err(|error| StoreError::corrupt("answer", error))?;
        let row_hash = sha256_hex(row.as_bytes());
        sqlx::query(
            "INSERT INTO answers (study_id, seq, session_id, trial_index, row, row_hash) VALUES ($1, $2, $3, $4, $5, $6)",
        )
        .bind(&session.study_id)
        .bind(seq)
        .bind(&session.session_id)
        .bind(new.trial_index)
        .bind(&row)
        .bind(&row_hash)
        .execute(&mut *writer)
        .await?;
        sqlx::query(
            "INSERT INTO answer_contents (study_id, seq, nonce, answer, payload) VALUES ($1, $2, $3, $4, $5)",
        )
        .bind(&session.study_id)
        .bind(seq)
        .bind(nonce.as_slice())
        .bind(&new.answer)
        .bind(&new.payload)
        .execute(&mut *writer)
        .await?;
        *self = Head { seq, row_hash };
        Ok(())
    }
}

/// What a chain of version 2 begins with: the last hash of version 1.
pub(crate) async fn genesis(connection: &mut SqliteConnection) -> Result<String, StoreError> {
    let last = sqlx::query_scalar("SELECT row_hash FROM responses ORDER BY response_id DESC LIMIT 1");
    Ok(last.fetch_optional(connection).await?.unwrap_or_else(|| GENESIS.to_owned()))
}

/// SHA-256 (hex) over nonce, answer, line feed and payload.
pub(crate) fn answer_hash(nonce: &[u8], answer: &[u8], payload: &[u8]) -> String {
    let parts = [nonce, answer, b"\n", payload];
    let hasher = parts.into_iter().fold(Sha256::new(), |hasher, part| hasher.chain_update(part));
    hasher.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

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
