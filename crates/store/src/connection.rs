//! Connections to the database, each set as all of its kind.

use crate::error::StoreError;
use crate::private;
use rusqlite::{Connection, OpenFlags};
use std::path::Path;
use std::time::Duration;

/// The database's name in its data folder.
pub(crate) const DATABASE: &str = "kelir.sqlite";

/// How long a lock that another process holds is waited for.
pub(crate) const BUSY: Duration = Duration::from_secs(5);

/// A connection that writes.
pub(crate) fn writing(path: &Path) -> Result<Connection, StoreError> {
    // SQLite gives the files beside it the rights of this one. A database that is there is never opened here: closing it again would drop every
    // lock that this process has on it (POSIX), and the next program that reads it would take the write-ahead log away.
    drop(private::private_file().create_new(true).open(path));
    let connection = Connection::open(path)?;
    connection.busy_timeout(BUSY)?;
    connection.pragma_update(None, "journal_mode", "wal")?;
    connection.pragma_update(None, "synchronous", "full")?;
    connection.pragma_update(None, "foreign_keys", true)?;
    connection.pragma_update(None, "recursive_triggers", true)?;
    // What answers touch stays in memory (in KiB), and a page that many of them touch is copied out of the log once for all (in pages).
    connection.pragma_update(None, "cache_size", -16_384)?;
    connection.pragma_update(None, "wal_autocheckpoint", 4_000)?;
    // More statements than the store has.
    connection.set_prepared_statement_cache_capacity(128);
    Ok(connection)
}

/// A connection that reads.
pub(crate) fn reading(path: &Path) -> Result<Connection, StoreError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(path, flags)?;
    connection.busy_timeout(BUSY)?;
    Ok(connection)
}
