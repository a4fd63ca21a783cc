//! Answers as analyses read them: only what they need, and only what has come since.
//!
//! sqlx hands every row from thread to thread, some ten microseconds each; a million answers want a cursor. So this reads with
//! rusqlite: the same SQLite library in the same process, read-only, on as many threads as there are cores.

use crate::clock::micros;
use crate::connection::{self, DATABASE};
use crate::error::StoreError;
use crate::sqlite::Store;
use crate::threads::patiently;
use kelir_study::StudyDefinition;
use kelir_study::answers::{Answers, Row};
use kelir_study::trials::{Shown, rules};
use rusqlite::fallible_streaming_iterator::FallibleStreamingIterator;
use rusqlite::{Connection, OptionalExtension, Statement};
use serde::de::IgnoredAny;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;

/// The answers to some versions of a study up to some moment. Answers are never changed, so it only ever grows:
/// [`Store::read_on`] adds what has come since.
#[derive(Clone, Debug)]
pub struct StoredAnswers {
    study_id: Arc<str>,
    versions: Arc<[String]>,
    answers: Arc<Answers>,
    /// The last row read of each chain.
    through: [i64; 2],
}

/// Fewer rows than this are not worth a second thread.
const SHARE: i64 = 20_000;

impl StoredAnswers {
    /// None read yet of these versions, by the design of `study`.
    pub fn new(study: &StudyDefinition, versions: &[String]) -> StoredAnswers {
        StoredAnswers {
            study_id: study.id.as_str().into(),
            versions: versions.into(),
            answers: Arc::new(Answers::new(study)),
            through: [0, 0],
        }
    }

    /// The answers themselves.
    pub fn answers(&self) -> Arc<Answers> {
        self.answers.clone()
    }
}

impl Store {
    /// Adds to `stored` what has come since it was last read. A row that says nothing (one that was tampered with, or whose answer was
    /// withdrawn) is passed over; verifying the chain names it.
    ///
    /// # Errors
    /// The database cannot be read; `stored` is as it was.
    pub async fn read_on(&self, stored: &mut StoredAnswers) -> Result<(), StoreError> {
        let source = Source {
            database: self.folder.join(DATABASE),
            study_id: stored.study_id.clone(),
            versions: stored.versions.clone(),
            empty: stored.answers.emptied(),
        };
        let after = stored.through;
        let read = patiently(move || {
            // The first chain is older than the second.
            let first = source.read(&FIRST, after[0], SHARE)?;
            let second = source.read(&SECOND, after[1], SHARE)?;
            Ok([first, second])
        });
        for (through, (newest, parts)) in stored.through.iter_mut().zip(read.await?) {
            if parts.iter().any(|part| !part.is_empty()) {
                let answers = Arc::make_mut(&mut stored.answers);
                parts.into_iter().for_each(|part| answers.append(part));
            }
            *through = newest;
        }
        Ok(())
    }
}

/// A chain of answers, as it is read.
struct Chain {
    /// The number of its last row.
    newest: &'static str,
    /// Its rows of these numbers.
    read: fn(&Connection, RangeInclusive<i64>, &mut Part<'_>) -> Result<(), StoreError>,
}

const FIRST: Chain =
    Chain { newest: "SELECT coalesce(max(response_id), 0) FROM responses WHERE ?1 <> ''", read: read_first };

const SECOND: Chain =
    Chain { newest: "SELECT coalesce(max(seq), 0) FROM answers WHERE study_id = ?1", read: read_second };

fn read_first(
    connection: &Connection,
    range: RangeInclusive<i64>,
    part: &mut Part<'_>,
) -> Result<(), StoreError> {
    let mut statement = connection.prepare(
        "SELECT session_id, pair_id, left_condition, right_condition, trial_index, choice = 'left', rt_ms, received_at FROM responses
         WHERE response_id BETWEEN ?1 AND ?2 ORDER BY response_id",
    )?;
    let mut rows = statement.query((range.start(), range.end()))?;
    while let Some(row) = rows.next()? {
        let [Some(session_id), Some(item), Some(left), Some(right)] = [0, 1, 2, 3].map(|i| text(row, i))
        else {
            continue;
        };
        if part.is_ours(session_id)? {
            let Ok(trial_index) = row.get(4) else { continue };
            let choice = Row::choice(session_id, trial_index, item, [left, right], row.get(5)?, row.get(6)?);
            let received_us = text(row, 7).and_then(micros);
            part.answers.push(Row { received_us, ..choice });
        }
    }
    Ok(())
}

/// A row of the second chain, without what analyses leave alone.
type RowValues<'a> = (
    IgnoredAny,
    IgnoredAny,
    IgnoredAny,
    IgnoredAny,
    Cow<'a, str>,
    Shown<'a>,
    Cow<'a, str>,
    IgnoredAny,
    IgnoredAny,
);

fn read_second(
    connection: &Connection,
    range: RangeInclusive<i64>,
    part: &mut Part<'_>,
) -> Result<(), StoreError> {
    let range = (&*part.source.study_id, range.start(), range.end());
    let mut rows = connection.prepare(
        "SELECT seq, session_id, trial_index, row FROM answers WHERE study_id = ?1 AND seq BETWEEN ?2 AND ?3 ORDER BY seq",
    )?;
    // Walked beside the rows: a join would look each answer up, at a quarter more time.
    let mut contents = connection.prepare(
        "SELECT seq, answer FROM answer_contents WHERE study_id = ?1 AND seq BETWEEN ?2 AND ?3 ORDER BY seq",
    )?;
    let (mut rows, mut contents) = (rows.query(range)?, contents.query(range)?);
    contents.advance()?;
    while let Some(row) = rows.next()? {
        let seq: i64 = row.get(0)?;
        while contents.get().map(|held| held.get::<_, i64>(0)).transpose()?.is_some_and(|held| held < seq) {
            contents.advance()?;
        }
        let Some(held) = contents.get() else { return Ok(()) };
        let (Some(session_id), Ok(trial_index), Some(answer)) = (text(row, 1), row.get(2), text(held, 1))
        else {
            continue;
        };
        if held.get::<_, i64>(0)? != seq || !part.is_ours(session_id)? {
            continue;
        }
        let Ok(values) =
            serde_json::from_slice::<RowValues<'_>>(row.get_ref(3)?.as_bytes().unwrap_or_default())
        else {
            continue;
        };
        let (_, _, _, _, kind, shown, received_at, _, _) = values;
        let Some(Ok(observation)) = rules(&kind).map(|rules| rules.observe(&shown, answer)) else { continue };
        part.answers.push(Row { session_id, trial_index, observation, received_us: micros(&received_at) });
    }
    Ok(())
}

/// A text; `None` where it is none, as what was tampered with can be.
fn text<'a>(row: &'a rusqlite::Row<'_>, column: usize) -> Option<&'a str> {
    row.get_ref(column).ok()?.as_str().ok()
}

/// Where answers are read from, and whose.
struct Source {
    database: PathBuf,
    study_id: Arc<str>,
    versions: Arc<[String]>,
    empty: Answers,
}

/// Answers that one thread reads.
struct Part<'a> {
    source: &'a Source,
    version: Statement<'a>,
    /// Whether a session is of the source's versions: looked up once a session, where a join would do so once a row.
    ours: HashMap<Box<str>, bool>,
    answers: Answers,
}

impl Part<'_> {
    fn is_ours(&mut self, session_id: &str) -> Result<bool, StoreError> {
        if let Some(ours) = self.ours.get(session_id) {
            return Ok(*ours);
        }
        let of = (session_id, &*self.source.study_id);
        let version: Option<String> = self.version.query_row(of, |row| row.get(0)).optional()?;
        let ours = version.is_some_and(|version| self.source.versions.contains(&version));
        self.ours.insert(session_id.into(), ours);
        Ok(ours)
    }
}

impl Source {
    /// The answers of a chain after a row, in parts by rising rows of at least `share`, and the number of the last.
    fn read(&self, chain: &Chain, after: i64, share: i64) -> Result<(i64, Vec<Answers>), StoreError> {
        let through: i64 =
            connection::reading(&self.database)?
                .query_row(chain.newest, [&*self.study_id], |row| row.get(0))?;
        if through <= after {
            return Ok((after, Vec::new()));
        }
        // What is committed up to here stays as it is, whatever is written meanwhile: each thread may look on its own.
        let rows = through - after;
        let cores = std::thread::available_parallelism().map_or(1, |n| n.get() as i64);
        let parts = (rows / share).clamp(1, cores);
        let range = |part: i64| after + 1 + rows * part / parts..=after + rows * (part + 1) / parts;
        let answers = std::thread::scope(|scope| {
            let threads: Vec<_> =
                (0..parts).map(|part| scope.spawn(move || self.read_part(chain, range(part)))).collect();
            let joined = threads.into_iter().map(|thread| {
                thread.join().unwrap_or_else(|_| Err(StoreError::corrupt("answers", "a reader failed")))
            });
            joined.collect::<Result<Vec<Answers>, StoreError>>()
        })?;
        Ok((through, answers))
    }

    fn read_part(&self, chain: &Chain, range: RangeInclusive<i64>) -> Result<Answers, StoreError> {
        let connection = connection::reading(&self.database)?;
        let version =
            connection.prepare("SELECT version FROM sessions WHERE session_id = ?1 AND study_id = ?2")?;
        let mut part = Part { source: self, version, ours: HashMap::new(), answers: self.empty.clone() };
        (chain.read)(&connection, range, &mut part)?;
        Ok(part.answers)
    }
}

#[cfg(test)]
mod tests;
