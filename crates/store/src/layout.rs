//! The database's layout: migrations, each applied once, in the table that sqlx keeps of them.

use crate::error::StoreError;
use crate::files::Files;
use crate::upgrade;
use rusqlite::{Connection, TransactionBehavior, params};
use sha2::{Digest, Sha384};

/// Applied migrations never change; a new one is a new line.
const MIGRATIONS: [(i64, &str, &str); 9] = [
    (1, "first", include_str!("../../../migrations/sqlite/0001_first.sql")),
    (2, "sessions counted", include_str!("../../../migrations/sqlite/0002_sessions_counted.sql")),
    (
        3,
        "versions, trials, answers",
        include_str!("../../../migrations/sqlite/0003_versions_trials_answers.sql"),
    ),
    (4, "visits", include_str!("../../../migrations/sqlite/0004_visits.sql")),
    (5, "slots", include_str!("../../../migrations/sqlite/0005_slots.sql")),
    (6, "packings", include_str!("../../../migrations/sqlite/0006_packings.sql")),
    (7, "persons", include_str!("../../../migrations/sqlite/0007_persons.sql")),
    (8, "sizes", include_str!("../../../migrations/sqlite/0008_sizes.sql")),
    (9, "late return", include_str!("../../../migrations/sqlite/0009_late_return.sql")),
];

/// As sqlx makes it: data folders of before have it.
const APPLIED: &str = "CREATE TABLE IF NOT EXISTS _sqlx_migrations (
    version BIGINT PRIMARY KEY,
    description TEXT NOT NULL,
    installed_on TIMESTAMP NOT NULL DEFAULT CURRENT_TIMESTAMP,
    success BOOLEAN NOT NULL,
    checksum BLOB NOT NULL,
    execution_time BIGINT NOT NULL
)";

/// Brings the layout up to date in one transaction: what cannot be brought over stays as it was, for whichever version wrote it.
pub(crate) fn bring_up_to_date(connection: &mut Connection, files: &Files) -> Result<(), StoreError> {
    let tx = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    tx.execute_batch(APPLIED)?;
    let applied = tx
        .prepare("SELECT version, checksum, success FROM _sqlx_migrations ORDER BY version")?
        .query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)))?
        .collect::<Result<Vec<(i64, Vec<u8>, bool)>, _>>()?;
    for (version, checksum, success) in &applied {
        let wrong = |what: &str| StoreError::Migrate(format!("migration {version} {what}"));
        let known = MIGRATIONS.iter().find(|(known, ..)| known == version);
        let (_, _, sql) = known.ok_or_else(|| wrong("is of a newer version of kelir"))?;
        if !success || Sha384::digest(sql)[..] != checksum[..] {
            return Err(wrong("is not the one that was applied here"));
        }
    }
    for (version, name, sql) in MIGRATIONS {
        if applied.iter().all(|(applied, ..)| *applied != version) {
            tx.execute_batch(sql)
                .map_err(|error| StoreError::Migrate(format!("migration {version}: {error}")))?;
            tx.execute(
                "INSERT INTO _sqlx_migrations (version, description, success, checksum, execution_time) VALUES (?1, ?2, TRUE, ?3, 0)",
                params![version, name, &Sha384::digest(sql)[..]],
            )?;
        }
    }
    upgrade::from_first_layout(&tx, files)?;
    Ok(tx.commit()?)
}
