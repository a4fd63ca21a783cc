use std::path::PathBuf;

/// Why the store could not do what it was asked. The text is for logs; none of it belongs in an answer to a browser.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused or failed.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The database refused or failed.
    #[error("database: {0}")]
    Sqlite(#[from] rusqlite::Error),
    /// What others of the same transaction ran into; nothing of it is stored.
    #[error("{message}")]
    Trouble {
        /// What kind of trouble.
        trouble: Trouble,
        /// What was said of it.
        message: String,
    },
    /// The database's layout could not be brought up to date.
    #[error("migrating the database: {0}")]
    Migrate(String),
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Another process serves the data folder.
    #[error("{folder}: another kelir serves this data folder ({holder})")]
    Held {
        /// The folder.
        folder: PathBuf,
        /// Who holds it: process, address and since when.
        holder: String,
    },
    /// A stored file is not what its name says.
    #[error("stimulus {sha256}: the stored bytes have another hash; the file is damaged")]
    Damaged {
        /// The hash that the bytes should have.
        sha256: String,
    },
    /// Bytes that are to be shown are no picture.
    #[error("a stimulus {0}")]
    Undecodable(String),
    /// A stored text could not be read back.
    #[error("stored {what} cannot be read: {message}")]
    Corrupt {
        /// Which column or table.
        what: &'static str,
        /// What is wrong with it.
        message: String,
    },
}

/// What keeps a store from storing that no request is to blame for. It can pass: whoever asks again later may be served.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// The disk is full.
    Full,
    /// Another process holds the database's lock.
    Locked,
    /// The database or its folder may not be written to.
    ReadOnly,
    /// The disk fails.
    Failing,
    /// The database's file is damaged.
    Damaged,
    /// The database's file is not where it was opened.
    Gone,
}

impl Trouble {
    /// What is the matter, for people.
    pub fn sentence(self) -> &'static str {
        match self {
            Trouble::Full => "The server's disk is full.",
            Trouble::Locked => "Another program holds the server's database.",
            Trouble::ReadOnly => "The server's data folder cannot be written to.",
            Trouble::Failing => "The server's disk does not do what it is asked.",
            Trouble::Damaged => "The server's database is damaged.",
            Trouble::Gone => "The server's database was moved, replaced or deleted.",
        }
    }

    /// What whoever meets it can do.
    pub fn advice(self) -> &'static str {
        match self {
            Trouble::Full | Trouble::Locked | Trouble::ReadOnly | Trouble::Failing => {
                "Please try again shortly."
            }
            Trouble::Gone => {
                "Nothing is stored until it is back where it was, or the server has been started again. Please try again later."
            }
            Trouble::Damaged => {
                "Nothing that is whole is lost by waiting, and trying again does not mend it. Researchers: keep a copy of the data folder, then put a \
                 backup in its place or let sqlite3's .recover read what can be read; the console says what is damaged, and kelir chain check afterwards \
                 whether every answer is there."
            }
        }
    }

    /// What a result code of SQLite's means, extended or not.
    fn of_code(code: i32) -> Option<Trouble> {
        use rusqlite::ffi;
        match code & 0xff {
            ffi::SQLITE_FULL => Some(Trouble::Full),
            ffi::SQLITE_BUSY | ffi::SQLITE_LOCKED => Some(Trouble::Locked),
            ffi::SQLITE_READONLY => Some(Trouble::ReadOnly),
            ffi::SQLITE_IOERR | ffi::SQLITE_CANTOPEN | ffi::SQLITE_NOMEM | ffi::SQLITE_PROTOCOL => {
                Some(Trouble::Failing)
            }
            ffi::SQLITE_CORRUPT | ffi::SQLITE_NOTADB => Some(Trouble::Damaged),
            _ => None,
        }
    }

    fn of_io(error: &std::io::Error) -> Option<Trouble> {
        use std::io::ErrorKind;
        match error.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
                Some(Trouble::Full)
            }
            ErrorKind::ReadOnlyFilesystem | ErrorKind::PermissionDenied => Some(Trouble::ReadOnly),
            ErrorKind::NotFound => None,
            _ => Some(Trouble::Failing),
        }
    }
}

impl StoreError {
    /// The trouble that this is; `None` where the request or what is stored is to blame.
    pub fn as_trouble(&self) -> Option<Trouble> {
        match self {
            StoreError::Trouble { trouble, .. } => Some(*trouble),
            StoreError::Sqlite(rusqlite::Error::SqliteFailure(failure, _)) => {
                Trouble::of_code(failure.extended_code)
            }
            StoreError::Database(sqlx::Error::Database(error)) => {
                error.code().and_then(|code| Trouble::of_code(code.parse().ok()?))
            }
            // Every connection is waiting for something.
            StoreError::Database(sqlx::Error::PoolTimedOut) => Some(Trouble::Failing),
            StoreError::Database(sqlx::Error::Io(source)) | StoreError::File { source, .. } => {
                Trouble::of_io(source)
            }
            _ => None,
        }
    }

    /// What to tell whoever asked: the trouble that this is, or that what is stored cannot be read, which is one job's and no reason to refuse
    /// others.
    pub fn as_told(&self) -> Option<Trouble> {
        let unreadable = match self {
            StoreError::Corrupt { .. } => true,
            StoreError::Sqlite(error) => {
                use rusqlite::Error::{
                    FromSqlConversionFailure, IntegralValueOutOfRange, InvalidColumnType, Utf8Error,
                };
                matches!(
                    error,
                    FromSqlConversionFailure(..)
                        | IntegralValueOutOfRange(..)
                        | InvalidColumnType(..)
                        | Utf8Error(..)
                )
            }
            StoreError::Database(error) => {
                matches!(error, sqlx::Error::ColumnDecode { .. } | sqlx::Error::Decode(_))
            }
            _ => false,
        };
        self.as_trouble().or(unreadable.then_some(Trouble::Damaged))
    }

    pub(crate) fn trouble(trouble: Trouble, message: impl ToString) -> Self {
        StoreError::Trouble { trouble, message: message.to_string() }
    }

    /// The same to somebody else of the same transaction.
    pub(crate) fn told(&self) -> Self {
        StoreError::trouble(self.as_trouble().unwrap_or(Trouble::Failing), self)
    }

    pub(crate) fn corrupt(what: &'static str, message: impl ToString) -> Self {
        StoreError::Corrupt { what, message: message.to_string() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;
    use rusqlite::{Connection, OpenFlags};

    #[test]
    fn what_sqlite_says_of_a_file_is_told_apart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sqlite");
        let writer = Connection::open(&path).unwrap();
        writer.execute_batch("CREATE TABLE t (x); PRAGMA max_page_count = 2").unwrap();
        let trouble =
            |result: Result<(), rusqlite::Error>| StoreError::from(result.unwrap_err()).as_trouble();
        let full = writer.execute_batch("INSERT INTO t VALUES (zeroblob(100000))");
        assert_eq!(trouble(full), Some(Trouble::Full));
        let reader = Connection::open_with_flags(&path, OpenFlags::SQLITE_OPEN_READ_ONLY).unwrap();
        assert_eq!(trouble(reader.execute_batch("INSERT INTO t VALUES (1)")), Some(Trouble::ReadOnly));
        writer.execute_batch("BEGIN IMMEDIATE").unwrap();
        let other = Connection::open(&path).unwrap();
        other.busy_timeout(std::time::Duration::ZERO).unwrap();
        assert_eq!(trouble(other.execute_batch("BEGIN IMMEDIATE")), Some(Trouble::Locked));
        assert_eq!(trouble(other.execute_batch("SELECT nothing")), None, "a wrong statement is no trouble");
        let gone = Connection::open(folder.path().join("none").join("a.sqlite")).map(drop);
        assert_eq!(trouble(gone), Some(Trouble::Failing));
        let text = folder.path().join("b.sqlite");
        std::fs::write(&text, "no database at all, however long this text may be".repeat(99)).unwrap();
        let damaged = Connection::open(&text).unwrap().execute_batch("SELECT * FROM sqlite_schema");
        assert_eq!(trouble(damaged), Some(Trouble::Damaged));
    }
}
