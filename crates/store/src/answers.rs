//! Answers as analyses read them: only what they need, and only what has come since.
//!
//! sqlx hands every row from thread to thread, some ten microseconds each; a million answers want a cursor. So this reads with
//! rusqlite: the same SQLite library in the same process, read-only, on as many threads as there are cores.

use crate::error::StoreError;
use crate::sqlite::{DATABASE, Store};
use kelir_study::StudyDefinition;
use kelir_study::answers::{Answers, Row};
use rusqlite::{Connection, OpenFlags, OptionalExtension};
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The answers to one version of a study up to some moment. Answers are never changed, so it only ever grows:
/// [`Store::read_on`] adds what has come since.
#[derive(Clone, Debug)]
pub struct StoredAnswers {
    study_id: Arc<str>,
    config_hash: Arc<str>,
    answers: Arc<Answers>,
    through: i64,
}

/// Fewer rows than this are not worth a second thread.
const SHARE: i64 = 20_000;

impl StoredAnswers {
    /// None read yet of this version of a study.
    pub fn new(study: &StudyDefinition) -> StoredAnswers {
        StoredAnswers {
            study_id: study.id.as_str().into(),
            config_hash: study.config_hash().into(),
            answers: Arc::new(Answers::new(study)),
            through: 0,
        }
    }

    /// The answers themselves.
    pub fn answers(&self) -> Arc<Answers> {
        self.answers.clone()
    }
}

impl Store {
    /// Adds to `stored` what has come since it was last read.
    ///
    /// # Errors
    /// The database cannot be read; `stored` is as it was.
    pub async fn read_on(&self, stored: &mut StoredAnswers) -> Result<(), StoreError> {
        let source = Source {
            database: self.folder.join(DATABASE),
            study_id: stored.study_id.clone(),
            config_hash: stored.config_hash.clone(),
            empty: stored.answers.emptied(),
        };
        let after = stored.through;
        let read = tokio::task::spawn_blocking(move || source.read(after, SHARE));
        let (through, parts) = read.await.map_err(|e| StoreError::corrupt("answers", e))??;
        if parts.iter().any(|part| !part.is_empty()) {
            let answers = Arc::make_mut(&mut stored.answers);
            parts.into_iter().for_each(|part| answers.append(part));
        }
        stored.through = through;
        Ok(())
    }
}

/// Where answers are read from, and whose.
struct Source {
    database: PathBuf,
    study_id: Arc<str>,
    config_hash: Arc<str>,
    empty: Answers,
}

impl Source {
    /// The answers after a response id, in parts by rising ids of at least `share` rows, and the id of the last.
    fn read(&self, after: i64, share: i64) -> Result<(i64, Vec<Answers>), StoreError> {
        let newest = "SELECT coalesce(max(response_id), 0) FROM responses";
        let through: i64 = self.connect()?.query_row(newest, [], |row| row.get(0))?;
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
                (0..parts).map(|part| scope.spawn(move || self.read_part(range(part)))).collect();
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

    fn read_part(&self, ids: RangeInclusive<i64>) -> Result<Answers, StoreError> {
        let connection = self.connect()?;
        // Looked up once a session: a join would do so once a row.
        let mut session = connection
            .prepare("SELECT study_id = ?2 AND config_hash = ?3 FROM sessions WHERE session_id = ?1")?;
        let mut ours = HashMap::<Box<str>, bool>::new();
        let mut statement = connection.prepare(
            "SELECT session_id, pair_id, left_condition, choice = 'left', rt_ms FROM responses
             WHERE response_id BETWEEN ?1 AND ?2 ORDER BY response_id",
        )?;
        let mut rows = statement.query((ids.start(), ids.end()))?;
        let mut answers = self.empty.clone();
        while let Some(row) = rows.next()? {
            let session_id = text(row, 0)?;
            let of_study = match ours.get(session_id) {
                Some(of_study) => *of_study,
                None => {
                    let keys = (session_id, &self.study_id, &self.config_hash);
                    let found = session.query_row(keys, |row| row.get(0)).optional()?.unwrap_or(false);
                    ours.insert(session_id.into(), found);
                    found
                }
            };
            if of_study {
                answers.push(Row {
                    session_id,
                    item_id: text(row, 1)?,
                    left_condition: text(row, 2)?,
                    chose_left: row.get(3)?,
                    rt_ms: row.get(4)?,
                });
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
