//! The database of a data folder: one connection that writes, several that read.

use crate::error::StoreError;
use crate::files::Files;
use crate::layout;
use crate::place::Place;
use crate::private;
use crate::readers::Readers;
use crate::stimuli::blocking;
use crate::writer::{Refused, Writer};
use rusqlite::Connection;
use sqlx::sqlite::{SqliteConnectOptions, SqlitePool, SqlitePoolOptions};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The database's name in its data folder.
pub(crate) const DATABASE: &str = "kelir.sqlite";

/// How long a lock that another process holds is waited for.
pub(crate) const BUSY: Duration = Duration::from_secs(5);

/// The database and the stimulus files of one data folder.
#[derive(Clone, Debug)]
pub struct Store {
    /// Writers queue here instead of failing as busy, and the chain of answers has one order.
    writer: Writer,
    pub(crate) readers: Readers,
    pub(crate) reader: SqlitePool,
    pub(crate) files: Files,
    pub(crate) folder: PathBuf,
}

impl Store {
    /// Opens `folder`, which it makes if need be, with `kelir.sqlite` and `stimuli/` inside, and brings the layout up to date.
    ///
    /// # Errors
    /// The folder or the database cannot be opened, was written by a newer version, or holds what cannot be brought over; it is as it was.
    pub async fn open(folder: &Path) -> Result<Store, StoreError> {
        private::folder(folder)?;
        private::close(folder);
        let files = Files::open(folder.join("stimuli"))?;
        let path = folder.join(DATABASE);
        let (database, stimuli) = (path.clone(), files.clone());
        blocking(move || layout::bring_up_to_date(&mut connect(&database)?, &stimuli)).await?;
        let place = Place::of(&path)?;
        let options = SqliteConnectOptions::new().filename(&path).busy_timeout(BUSY).read_only(true);
        let reader = SqlitePoolOptions::new().max_connections(4).connect_with(options).await?;
        let readers = Readers::new(path.clone());
        let writer = Writer::start(place, move || connect(&path))?;
        Ok(Store { writer, readers, reader, files, folder: folder.to_owned() })
    }

    /// The data folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Runs a job in a transaction; committed and synced when this returns `Ok`. A job that returns an error has written nothing.
    pub(crate) async fn write<T: Send + 'static>(
        &self,
        job: impl FnOnce(&Connection) -> Result<T, StoreError> + Send + 'static,
    ) -> Result<T, StoreError> {
        self.write_or(|connection| job(connection).map_err(Refused::Store)).await
    }

    /// The same where the job also asks its caller, who has errors of their own.
    pub(crate) async fn write_or<T: Send + 'static, E: From<StoreError> + Send + 'static>(
        &self,
        job: impl FnOnce(&Connection) -> Result<T, Refused<E>> + Send + 'static,
    ) -> Result<T, E> {
        self.writer.run(job).await
    }

    /// The writer's `synchronous` (2 is FULL) and `foreign_keys` (1 is on).
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn pragmas(&self) -> Result<(i64, i64), StoreError> {
        let pragma =
            |connection: &Connection, name| connection.pragma_query_value(None, name, |row| row.get(0));
        self.write(move |connection| {
            Ok((pragma(connection, "synchronous")?, pragma(connection, "foreign_keys")?))
        })
        .await
    }

    /// Closes every connection, after what is under way.
    pub async fn close(&self) {
        self.reader.close().await;
        self.readers.close();
        self.writer.close().await;
    }
}

/// A connection that writes.
fn connect(path: &Path) -> Result<Connection, StoreError> {
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
