//! The database of a data folder: one connection that writes, several that read.

use crate::error::StoreError;
use crate::files::Files;
use crate::readers::Readers;
use crate::writer::{Refused, Writer};
use rusqlite::Connection;
use sqlx::sqlite::SqlitePool;
use std::path::{Path, PathBuf};

/// The database and the stimulus files of one data folder.
#[derive(Clone, Debug)]
pub struct Store {
    /// Writers queue here instead of failing as busy, and the chain of answers has one order.
    pub(crate) writer: Writer,
    pub(crate) readers: Readers,
    pub(crate) reader: SqlitePool,
    pub(crate) files: Files,
    pub(crate) folder: PathBuf,
}

impl Store {
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
