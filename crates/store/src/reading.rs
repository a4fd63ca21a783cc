//! Answers as analyses read them: only what they need, and only what has come since.
//!
//! sqlx hands every row from thread to thread, some ten microseconds each; a million answers want a cursor. So this reads with
//! rusqlite: the same SQLite library in the same process, read-only, on as many threads as there are cores.

use crate::error::StoreError;
use crate::sqlite::{DATABASE, Store};
use kelir_study::StudyDefinition;
use kelir_study::answers::{Answers, Row};
use kelir_study::trials::{Shown, rules};
use rusqlite::{Connection, OpenFlags, OptionalExtension};
use serde::de::IgnoredAny;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

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
        let read = tokio::task::spawn_blocking(move || {
            // The first chain is older than the second.
            let first = source.read(&FIRST, after[0], SHARE)?;
            let second = source.read(&SECOND, after[1], SHARE)?;
            Ok::<_, StoreError>([first, second])
        });
        let read = read.await.map_err(|e| StoreError::corrupt("answers", e))??;
        for (through, (newest, parts)) in stored.through.iter_mut().zip(read) {
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
    newest: &'static str,
    rows: &'static str,
    push: fn(&mut Answers, &str, &rusqlite::Row<'_>) -> Result<(), StoreError>,
}

const FIRST: Chain = Chain {
    newest: "SELECT coalesce(max(response_id), 0) FROM responses WHERE ?1 <> ''",
    rows: "SELECT session_id, trial_index, pair_id, left_condition, right_condition, choice = 'left', rt_ms FROM responses
           WHERE ?1 <> '' AND response_id BETWEEN ?2 AND ?3 ORDER BY response_id",
    push: push_first,
};

const SECOND: Chain = Chain {
    newest: "SELECT coalesce(max(seq), 0) FROM answers WHERE study_id = ?1",
    rows: "SELECT a.session_id, a.trial_index, a.row, c.answer FROM answers a JOIN answer_contents c USING (study_id, seq)
           WHERE a.study_id = ?1 AND a.seq BETWEEN ?2 AND ?3 AND c.answer IS NOT NULL ORDER BY a.seq",
    push: push_second,
};

fn push_first(answers: &mut Answers, session_id: &str, row: &rusqlite::Row<'_>) -> Result<(), StoreError> {
    let sides = [text(row, 3)?, text(row, 4)?];
    answers.push(Row::choice(session_id, row.get(1)?, text(row, 2)?, sides, row.get(5)?, row.get(6)?));
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
    IgnoredAny,
    IgnoredAny,
    IgnoredAny,
);

fn push_second(answers: &mut Answers, session_id: &str, row: &rusqlite::Row<'_>) -> Result<(), StoreError> {
    let Ok((_, _, _, _, kind, shown, _, _, _)) = serde_json::from_str::<RowValues<'_>>(text(row, 2)?) else {
        return Ok(());
    };
    let Some(rules) = rules(&kind) else { return Ok(()) };
    if let Ok(observation) = rules.observe(&shown, text(row, 3)?) {
        answers.push(Row { session_id, trial_index: row.get(1)?, observation });
    }
    Ok(())
}

/// Where answers are read from, and whose.
struct Source {
    database: PathBuf,
    study_id: Arc<str>,
    versions: Arc<[String]>,
    empty: Answers,
}

impl Source {
    /// The answers of a chain after a row, in parts by rising rows of at least `share`, and the number of the last.
    fn read(&self, chain: &Chain, after: i64, share: i64) -> Result<(i64, Vec<Answers>), StoreError> {
        let through: i64 = self.connect()?.query_row(chain.newest, [&*self.study_id], |row| row.get(0))?;
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

    fn connect(&self) -> Result<Connection, rusqlite::Error> {
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let connection = Connection::open_with_flags(&self.database, flags)?;
        connection.busy_timeout(Duration::from_secs(10))?;
        Ok(connection)
    }

    fn read_part(&self, chain: &Chain, rows: RangeInclusive<i64>) -> Result<Answers, StoreError> {
        let connection = self.connect()?;
        // Looked up once a session: a join would do so once a row.
        let mut version =
            connection.prepare("SELECT version FROM sessions WHERE session_id = ?1 AND study_id = ?2")?;
        let mut ours = HashMap::<Box<str>, bool>::new();
        let mut statement = connection.prepare(chain.rows)?;
        let mut rows = statement.query((&*self.study_id, rows.start(), rows.end()))?;
        let mut answers = self.empty.clone();
        while let Some(row) = rows.next()? {
            let session_id = text(row, 0)?;
            let ours = match ours.get(session_id) {
                Some(ours) => *ours,
                None => {
                    let found: Option<String> =
                        version.query_row((session_id, &*self.study_id), |row| row.get(0)).optional()?;
                    let found = found.is_some_and(|version| self.versions.contains(&version));
                    ours.insert(session_id.into(), found);
                    found
                }
            };
            if ours {
                (chain.push)(&mut answers, session_id, row)?;
            }
        }
        Ok(answers)
    }
}

fn text<'a>(row: &'a rusqlite::Row<'_>, column: usize) -> Result<&'a str, StoreError> {
    row.get_ref(column)?.as_str().map_err(|e| StoreError::corrupt("answer", e))
}

#[cfg(test)]
mod tests;
