//! Opening the database: pragmas, pools, migrations.

use crate::error::StoreError;
use crate::files::Files;
use crate::upgrade;
use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::sqlite::{
    SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions, SqliteSynchronous,
};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Applied migrations never change; a new one is a new line.
const MIGRATIONS: [(i64, &str, &str); 5] = [
    (1, "first", include_str!("../../../migrations/sqlite/0001_first.sql")),
    (2, "sessions counted", include_str!("../../../migrations/sqlite/0002_sessions_counted.sql")),
    (
        3,
        "versions, trials, answers",
        include_str!("../../../migrations/sqlite/0003_versions_trials_answers.sql"),
    ),
    (4, "visits", include_str!("../../../migrations/sqlite/0004_visits.sql")),
    (6, "packings", include_str!("../../../migrations/sqlite/0006_packings.sql")),
];

/// The database's name in its data folder.
pub(crate) const DATABASE: &str = "kelir.sqlite";

/// The database and the stimulus files of one data folder.
#[derive(Clone, Debug)]
pub struct Store {
    /// One connection: writers queue here instead of failing as busy, and the chain of answers has one order.
    pub(crate) writer: SqlitePool,
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
        std::fs::create_dir_all(folder)
            .map_err(|source| StoreError::File { path: folder.to_owned(), source })?;
        let options = SqliteConnectOptions::new()
            .filename(folder.join(DATABASE))
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Full)
            .foreign_keys(true)
            .pragma("recursive_triggers", "on")
            .busy_timeout(Duration::from_secs(10));
        let writer = SqlitePoolOptions::new().max_connections(1).connect_with(options.clone()).await?;
        let migrations = MIGRATIONS.map(|(version, name, sql)| {
            Migration::new(version, name.into(), MigrationType::Simple, sql.into_sql_str(), false)
        });
        let files = Files::open(folder.join("stimuli"))?;
        // One transaction: what cannot be brought over stays as it was, for whichever version wrote it.
        let mut tx = writer.begin_with("BEGIN IMMEDIATE").await?;
        Migrator::with_migrations(migrations.into()).run(&mut *tx).await?;
        upgrade::from_first_layout(&mut tx, &files).await?;
        tx.commit().await?;
        let reader =
            SqlitePoolOptions::new().max_connections(4).connect_with(options.read_only(true)).await?;
        Ok(Store { writer, reader, files, folder: folder.to_owned() })
    }

    /// The data folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Whether the database answers.
    ///
    /// # Errors
    /// It does not.
    pub async fn ping(&self) -> Result<(), StoreError> {
        sqlx::query("SELECT 1").execute(&self.reader).await?;
        Ok(())
    }

    /// The writer's `synchronous` (2 is FULL) and `foreign_keys` (1 is on).
    ///
    /// # Errors
    /// The database cannot be read.
    pub async fn pragmas(&self) -> Result<(i64, i64), StoreError> {
        let synchronous = sqlx::query_scalar("PRAGMA synchronous").fetch_one(&self.writer).await?;
        let foreign_keys = sqlx::query_scalar("PRAGMA foreign_keys").fetch_one(&self.writer).await?;
        Ok((synchronous, foreign_keys))
    }

    /// Closes every connection, after what is under way.
    pub async fn close(&self) {
        self.reader.close().await;
        self.writer.close().await;
    }
}
