//! Persons: what happens when somebody comes whose id has a session already, and the sessions as analyses need them.

use crate::clock;
use crate::error::StoreError;
use crate::sessions::{NewSession, Session, SessionKind};
use crate::sqlite::Store;
use kelir_study::Repeat;
use kelir_study::visits::{Flag, Visit};
use rusqlite::{Connection, OptionalExtension};
use std::time::Duration;

/// What came of somebody's wish to begin.
#[derive(Clone, Debug)]
pub enum Begun {
    /// A new session.
    New(Session),
    /// The session that this person had goes on, with the new token in place of the old one.
    Again(Session),
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
            Begun::Refused { .. } => None,
        }
    }
}

/// What the writer made of it.
pub(crate) enum Settled {
    /// A new session.
    New(Box<Session>),
    /// The session of this id goes on.
    Again(String),
    /// None.
    Refused { is_finished: bool },
}

/// The session of the same person that comes first to mind: a finished one, else the last with consent, else the last.
const OF_PERSON: &str = "SELECT session_id, consented_at IS NOT NULL, completed_at IS NOT NULL FROM sessions
     WHERE study_id = ?1 AND subject_id = ?2 AND session_id <> subject_id AND kind = 'participant'
     ORDER BY completed_at IS NULL, consented_at IS NULL, session_id DESC LIMIT 1";

/// What the study's policy makes of somebody whose id has a session already; `None`: a new session begins, flagged where need be. In the
/// transaction that begins it, so that two tabs at once are two visits of one person too.
pub(crate) fn settle(writer: &Connection, new: &mut NewSession) -> Result<Option<Settled>, StoreError> {
    let Some(person) = new.subject_id.as_ref().filter(|_| new.kind == SessionKind::Participant) else {
        return Ok(None);
    };
    let known = writer
        .prepare_cached(OF_PERSON)?
        .query_row([&new.study_id, person], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)))
        .optional()?;
    let Some((session_id, is_consented, is_finished)): Option<(String, bool, bool)> = known else {
        return Ok(None);
    };
    match new.repeat {
        Repeat::Flag => {
            new.flags.push(Flag::RepeatedId.as_str().to_owned());
            Ok(None)
        }
        // Without consent nothing has been seen or said: whoever has the link may begin.
        _ if !is_consented => go_on(writer, session_id, new).map(Some),
        Repeat::Resume if !is_finished => go_on(writer, session_id, new).map(Some),
        Repeat::Resume | Repeat::Refuse => Ok(Some(Settled::Refused { is_finished })),
    }
}

fn go_on(writer: &Connection, session_id: String, new: &NewSession) -> Result<Settled, StoreError> {
    let mut renew = writer
        .prepare_cached("UPDATE sessions SET token_hash = ?2, last_seen_at = ?3 WHERE session_id = ?1")?;
    renew.execute([&session_id, &new.token_hash, &clock::now()])?;
    Ok(Settled::Again(session_id))
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
        self.readers
            .read(move |connection| {
                let mut statement = connection.prepare_cached(
                    "SELECT session_id, subject_id, kind, flags, consented_at, completed_at, completed_at IS NULL AND last_seen_at > ?3
                     FROM sessions WHERE study_id = ?1 AND version IN (SELECT value FROM json_each(?2)) ORDER BY session_id",
                )?;
                let since = clock::before_now(idle);
                let visits = statement.query_map([study_id, versions, since], read_visit)?;
                Ok(visits.collect::<Result<Vec<Visit>, _>>()?)
            })
            .await
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
    })
}
