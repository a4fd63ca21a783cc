//! Answers: appended once, never changed.

use crate::answer_row::{AnswerRow, answer_hash, read_answer};
use crate::clock;
use crate::error::StoreError;
use crate::files::sha256_hex;
use crate::first_chain::{self, genesis};
use crate::plans::{NextTrials, PlannedTrial, decided, insert_trials, next_trial, plan_of, trial};
use crate::session_row::{Session, session};
use crate::sessions;
use crate::sqlite::Store;
use crate::writer::Refused;
use kelir_study::trials::Checked;
use rusqlite::{Connection, OptionalExtension, params};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use sqlx::sqlite::SqliteRow;
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
    /// The size at which the page says that it showed the stimuli.
    pub stimulus_size: Option<[u32; 2]>,
}

/// What a page sent of one trial.
#[derive(Clone, Debug)]
pub struct SentAnswer {
    /// Session's id.
    pub session_id: String,
    /// Index of the trial in its session.
    pub trial_index: u32,
    /// All of it, to the byte.
    pub payload: String,
    /// Number of trials that the page knows; absent: it asks for none.
    pub known: Option<u32>,
    /// The plan that the page showed the trial of, as [`Store::plan`] told it; absent: the page knows no plans apart.
    pub plan: Option<String>,
}

/// What came of an answer, and where its session stands then.
#[derive(Clone, Debug)]
pub struct Taken {
    /// The session as it was.
    pub session: Session,
    /// Whether it is stored.
    pub appended: Appended,
    /// The first decided trial without an answer.
    pub next_trial: Option<u32>,
    /// Whether answers will decide more trials.
    pub more: bool,
    /// The decided trials that the page does not know.
    pub trials: Vec<PlannedTrial>,
    /// Indices of the trials that have an answer, where any are told.
    pub answered: Vec<u32>,
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
    /// The trial was shown of a plan that has been decided anew since.
    OtherPlan,
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

/// What a session has been shown and has answered, for whoever decides what comes next.
#[derive(Debug)]
pub struct Progress {
    /// The trials decided so far.
    pub trials: Vec<PlannedTrial>,
    /// Answers by trial index, as canonical JSON.
    pub answers: BTreeMap<u32, String>,
}

impl Store {
    /// Appends an answer, and the trials that follow from it, in one transaction: `next` is asked for them where the session's plan goes on.
    /// When it returns [`Appended::Stored`] or [`Appended::Same`], the answer is on disk.
    ///
    /// # Errors
    /// The database fails, or `next` does; nothing is stored.
    pub async fn append_answer<E: From<StoreError> + Send + 'static>(
        &self,
        session: &Session,
        new: &NewAnswer,
        next: impl FnOnce(Progress) -> Result<NextTrials, E> + Send + 'static,
    ) -> Result<Appended, E> {
        let NewAnswer { trial_index, answer, payload, stimulus_size } = new.clone();
        let session_id = session.session_id.clone();
        let sent = SentAnswer { session_id, trial_index, payload, known: None, plan: None };
        let admit = |session: Option<Session>| {
            Ok(session.ok_or_else(|| StoreError::corrupt("session", "is not stored"))?)
        };
        let check = move |_: &kelir_study::Trial| Ok(Checked { answer, stimulus_size });
        let next = |_: &Session, progress| next(progress);
        Ok(self.take_answer(sent, admit, check, next).await?.appended)
    }

    /// Takes what a page sent, all in one transaction: `admit` says whose session it is, `check` what the answer to the trial is,
    /// [`Store::append_answer`] has the rest.
    ///
    /// # Errors
    /// The database fails, or `admit`, `check` or `next` does; nothing is stored.
    pub async fn take_answer<E: From<StoreError> + Send + 'static>(
        &self,
        sent: SentAnswer,
        admit: impl FnOnce(Option<Session>) -> Result<Session, E> + Send + 'static,
        check: impl FnOnce(&kelir_study::Trial) -> Result<Checked, E> + Send + 'static,
        next: impl FnOnce(&Session, Progress) -> Result<NextTrials, E> + Send + 'static,
    ) -> Result<Taken, E> {
        self.write_or(move |writer| {
            let session = admit(session(writer, &sent.session_id)?).map_err(Refused::Caller)?;
            take(writer, session, sent, check, next)
        })
        .await
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

fn take<E>(
    writer: &Connection,
    session: Session,
    sent: SentAnswer,
    check: impl FnOnce(&kelir_study::Trial) -> Result<Checked, E>,
    next: impl FnOnce(&Session, Progress) -> Result<NextTrials, E>,
) -> Result<Taken, Refused<E>> {
    let SentAnswer { trial_index, payload, known, plan, .. } = sent;
    let not_taken = |session: Session, appended| {
        let more = session.more;
        Ok(Taken { session, appended, next_trial: None, more, trials: vec![], answered: vec![] })
    };
    if plan.is_some() && plan != plan_of(writer, &session.session_id)? {
        return not_taken(session, Appended::OtherPlan);
    }
    let Some(planned) = trial(writer, &session.session_id, trial_index)? else {
        return not_taken(session, Appended::NoSuchTrial);
    };
    let Checked { answer, stimulus_size } = check(&planned.trial).map_err(Refused::Caller)?;
    let new = NewAnswer { trial_index, answer, payload, stimulus_size };
    let (appended, more) = append(writer, &session, &planned, &new, next)?;
    let (mut trials, mut answered) = (Vec::new(), Vec::new());
    if let Some(known) = known {
        trials = decided(writer, &session.session_id, known)?;
        answered = sessions::answered(writer, &session.session_id)?;
    }
    let next_trial = next_trial(writer, &session.session_id)?;
    Ok(Taken { session, appended, next_trial, more, trials, answered })
}

/// What came of an answer, and whether answers will decide more trials then.
fn append<E>(
    writer: &Connection,
    session: &Session,
    planned: &PlannedTrial,
    new: &NewAnswer,
    next: impl FnOnce(&Session, Progress) -> Result<NextTrials, E>,
) -> Result<(Appended, bool), Refused<E>> {
    if let Some(stored) = stored(writer, &session.session_id, new)? {
        return Ok((stored, session.more));
    }
    let mut chain = Head::read(writer, &session.study_id)?;
    let now = clock::now();
    chain.append(writer, session, planned, new, &now)?;
    let mut more = session.more;
    if more {
        let trials = decided(writer, &session.session_id, 0)?;
        let answers = answers_of(writer, &session.session_id)?;
        let next = next(session, Progress { answers, trials }).map_err(Refused::Caller)?;
        insert_trials(writer, &session.session_id, &next.trials, &now, chain.seq)?;
        more = next.more;
    }
    let mut seen =
        writer.prepare_cached("UPDATE sessions SET last_seen_at = ?2, more = ?3 WHERE session_id = ?1")?;
    seen.execute(params![session.session_id, now, more])?;
    Ok((Appended::Stored, more))
}

/// What stands where `new` would go, if anything does.
fn stored(writer: &Connection, session_id: &str, new: &NewAnswer) -> Result<Option<Appended>, StoreError> {
    let place = (session_id, new.trial_index);
    let different = |received_at, answer: Option<String>, payload: Option<String>| {
        let json = |text: Option<String>| text.and_then(|text| serde_json::from_str(&text).ok());
        let stored = StoredAnswer { received_at, answer: json(answer), payload: json(payload) };
        Some(Appended::Different(Box::new(stored)))
    };
    let mut second = writer.prepare_cached(
        "SELECT json_extract(a.row, '$[6]'), c.answer, c.payload FROM answers a
         LEFT JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq
         WHERE a.session_id = ?1 AND a.trial_index = ?2",
    )?;
    let found = second
        .query_row(place, |row| Ok((row.get(0)?, row.get(1)?, row.get::<_, Option<String>>(2)?)))
        .optional()?;
    if let Some((received_at, answer, payload)) = found {
        let same = payload.as_ref() == Some(&new.payload);
        return Ok(if same { Some(Appended::Same) } else { different(received_at, answer, payload) });
    }
    let mut first = writer.prepare_cached(
        "SELECT r.received_at, r.choice, r.rt_ms, p.payload FROM responses r LEFT JOIN response_payloads p USING (response_id)
         WHERE r.session_id = ?1 AND r.trial_index = ?2",
    )?;
    let found = first
        .query_row(place, |row| {
            Ok((row.get(0)?, row.get::<_, String>(1)?, row.get(2)?, row.get::<_, Option<String>>(3)?))
        })
        .optional()?;
    let Some((received_at, choice, rt_ms, payload)) = found else { return Ok(None) };
    // Version 1 kept what came as its own JSON writer has it.
    let sent: Option<Value> = serde_json::from_str(&new.payload).ok();
    if payload.is_some() && payload == sent.map(|sent| sent.to_string()) {
        return Ok(Some(Appended::Same));
    }
    Ok(different(received_at, Some(first_chain::answer(&choice, rt_ms)?), payload))
}

/// Every answer of a session by trial index, as canonical JSON; without those withdrawn.
fn answers_of(connection: &Connection, session_id: &str) -> Result<BTreeMap<u32, String>, StoreError> {
    let mut answers = BTreeMap::new();
    let mut first = connection
        .prepare_cached("SELECT trial_index, choice, rt_ms FROM responses WHERE session_id = ?1")?;
    let mut rows = first.query([session_id])?;
    while let Some(row) = rows.next()? {
        let answer = first_chain::answer(&row.get::<_, String>(1)?, row.get(2)?)?;
        answers.insert(row.get(0)?, answer);
    }
    let mut second = connection.prepare_cached(
        "SELECT a.trial_index, c.answer FROM answers a JOIN answer_contents c ON c.study_id = a.study_id AND c.seq = a.seq
         WHERE a.session_id = ?1 AND c.answer IS NOT NULL",
    )?;
    let mut rows = second.query([session_id])?;
    while let Some(row) = rows.next()? {
        answers.insert(row.get(0)?, row.get(1)?);
    }
    Ok(answers)
}

/// The end of a study's chain of answers, while its one writer holds it.
pub(crate) struct Head {
    seq: i64,
    row_hash: String,
}

impl Head {
    /// The last row's; for a study without any, what its chain begins with.
    pub(crate) fn read(writer: &Connection, study_id: &str) -> Result<Head, StoreError> {
        let mut last = writer.prepare_cached(
            "SELECT seq, row_hash FROM answers WHERE study_id = ?1 ORDER BY seq DESC LIMIT 1",
        )?;
        let head = |row: &rusqlite::Row<'_>| Ok(Head { seq: row.get(0)?, row_hash: row.get(1)? });
        Ok(match last.query_row([study_id], head).optional()? {
            Some(head) => head,
            None => Head { seq: 0, row_hash: genesis(writer)? },
        })
    }

    /// Writes the next row and what it holds, and moves on to it.
    pub(crate) fn append(
        &mut self,
        writer: &Connection,
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
            planned.shown(new.stimulus_size)?,
            now,
            answer_hash,
            self.row_hash,
        ]);
        let row = kelir_jcs::canonical(values).map_err(|error| StoreError::corrupt("answer", error))?;
        let row_hash = sha256_hex(row.as_bytes());
        let mut insert = writer.prepare_cached(
            "INSERT INTO answers (study_id, seq, session_id, trial_index, row, row_hash) VALUES (?1, ?2, ?3, ?4, ?5, ?6)",
        )?;
        insert.execute(params![session.study_id, seq, session.session_id, new.trial_index, row, row_hash])?;
        let mut insert = writer.prepare_cached(
            "INSERT INTO answer_contents (study_id, seq, nonce, answer, payload) VALUES (?1, ?2, ?3, ?4, ?5)",
        )?;
        insert.execute(params![session.study_id, seq, nonce, new.answer, new.payload])?;
        *self = Head { seq, row_hash };
        Ok(())
    }
}
