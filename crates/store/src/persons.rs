//! Persons: what happens when somebody comes whose id has a session already, and the sessions as analyses need them.

use crate::clock;
use crate::error::StoreError;
use crate::session_row::{NewSession, Session, SessionKind, read_session, session_columns};
use crate::sqlite::Store;
use kelir_study::Repeat;
use kelir_study::visits::{Flag, Visit};
use rusqlite::{Connection, params};
use std::time::Duration;

/// What came of somebody's wish to begin.
#[derive(Clone, Debug)]
pub enum Begun {
    /// A new session.
    New(Session),
    /// The session that this person had goes on, with the new token in place of the old one.
    Again(Session),
    /// The session that the same key began has gone on since.
    KeyUsed,
    /// Nobody takes part twice, and this person has begun already.
    Refused {
        /// Whether that session is finished.
        is_finished: bool,
    },
}

impl Begun {
    /// The session that goes on from here; `None` where none does.
    pub fn session(self) -> Option<Session> {
        match self {
            Begun::New(session) | Begun::Again(session) => Some(session),
            Begun::KeyUsed | Begun::Refused { .. } => None,
        }
    }
}

/// The session of the same person that comes first to mind: a finished one, else the last with consent, else the last.
const OF_PERSON: &str = concat!(
    "SELECT ",
    session_columns!(),
    " FROM sessions WHERE study_id = ?1 AND subject_id = ?2 AND session_id <> subject_id AND kind = 'participant'
     ORDER BY completed_at IS NULL, consented_at IS NULL, session_id DESC LIMIT 1"
);

/// What the study's policy makes of somebody whose id has a session already; `None`: a new session begins, flagged where need be. In the
/// transaction that begins it, so that two tabs at once are two visits of one person too.
pub(crate) fn settle(writer: &Connection, new: &mut NewSession) -> Result<Option<Begun>, StoreError> {
    if let Some(begun) = asked_again(writer, new)? {
        return Ok(Some(begun));
    }
    let Some(person) = new.subject_id.as_ref().filter(|_| new.kind == SessionKind::Participant) else {
        return Ok(None);
    };
    let mut query = writer.prepare_cached(OF_PERSON)?;
    let mut known = query.query([&new.study_id, person])?;
    let Some(known) = known.next()?.map(read_session).transpose()? else { return Ok(None) };
    let is_finished = known.completed_at.is_some();
    match new.repeat {
        Repeat::Flag => {
            new.flags.push(Flag::RepeatedId.as_str().to_owned());
            Ok(None)
        }
        // Without consent nothing has been seen or said: whoever has the link may begin.
        _ if known.consented_at.is_none() => go_on(writer, known, new).map(Some),
        Repeat::Resume if !is_finished => go_on(writer, known, new).map(Some),
        Repeat::Resume | Repeat::Refuse => Ok(Some(Begun::Refused { is_finished })),
    }
}

/// The session that the same wish began: whoever asks for it again has not heard of it, or of no consent to it.
fn asked_again(writer: &Connection, new: &NewSession) -> Result<Option<Begun>, StoreError> {
    let Some(key) = &new.start_key else { return Ok(None) };
    let mut query = writer.prepare_cached(concat!(
        "SELECT ",
        session_columns!(),
        " FROM sessions WHERE study_id = ?1 AND start_key = ?2"
    ))?;
    let mut known = query.query([&new.study_id, key])?;
    let Some(known) = known.next()?.map(read_session).transpose()? else { return Ok(None) };
    if known.consented_at.is_some() {
        return Ok(Some(Begun::KeyUsed));
    }
    go_on(writer, known, new).map(Some)
}

fn go_on(writer: &Connection, mut known: Session, new: &NewSession) -> Result<Begun, StoreError> {
    (known.token_hash, known.last_seen_at) = (new.token_hash.clone(), clock::now());
    writer.execute(
        "UPDATE sessions SET token_hash = ?2, last_seen_at = ?3 WHERE session_id = ?1",
        params![known.session_id, known.token_hash, known.last_seen_at],
    )?;
    Ok(Begun::Again(known))
}

impl Store {
    /// The sessions of these versions of a study, in the order they began; who was not heard of for `idle` is no longer active.
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn visits(
        &self,
        study_id: &str,
        versions: &[String],
        idle: Duration,
    ) -> Result<Vec<Visit>, StoreError> {
        let study_id = study_id.to_owned();
        let versions = serde_json::to_string(versions).map_err(|e| StoreError::corrupt("versions", e))?;
        let read = self.readers.read(move |connection| {
            let mut statement = connection.prepare(
                "SELECT session_id, subject_id, kind, flags, consented_at, completed_at, completed_at IS NULL AND last_seen_at > ?3,
                 version, slot
                 FROM sessions WHERE study_id = ?1 AND version IN (SELECT value FROM json_each(?2)) ORDER BY session_id",
            )?;
            let visits = statement.query_map((study_id, versions, clock::before_now(idle)), read_visit)?;
            Ok(visits.collect::<Result<Vec<Visit>, _>>()?)
        });
        read.await
    }
}

fn read_visit(row: &rusqlite::Row<'_>) -> Result<Visit, rusqlite::Error> {
    let (session_id, subject_id): (String, String) = (row.get(0)?, row.get(1)?);
    let (kind, flags): (String, String) = (row.get(2)?, row.get(3)?);
    let time = |text: Option<String>| text.as_deref().and_then(clock::micros);
    let words: Vec<String> = serde_json::from_str(&flags).unwrap_or_default();
    Ok(Visit {
        person: (subject_id != session_id).then_some(subject_id),
        session_id,
        kind: SessionKind::ALL.iter().copied().find(|known| known.as_str() == kind).unwrap_or_default(),
        flags: words.iter().filter_map(|word| Flag::named(word)).collect(),
        consented_us: time(row.get(4)?),
        completed_us: time(row.get(5)?),
        is_active: row.get(6)?,
        version: row.get(7)?,
        slot: row.get(8)?,
    })
}
