//! Whether the database is whole, as SQLite itself sees it.

use crate::connection::DATABASE;
use crate::error::StoreError;
use crate::sqlite::Store;
use crate::threads::patiently;
use rusqlite::{Connection, OpenFlags};
use std::time::Duration;

/// Faults that are named; where one page is damaged, there are seldom few.
const MOST_FAULTS: u32 = 5;

impl Store {
    /// SQLite's `quick_check` of the whole database: what it finds, shortly; nothing where all is well. It reads beside everything else.
    ///
    /// # Errors
    /// The database cannot even be opened or read.
    pub async fn quick_check(&self) -> Result<Vec<String>, StoreError> {
        let database = self.folder().join(DATABASE);
        patiently(move || {
            let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
            let connection = Connection::open_with_flags(database, flags)?;
            connection.busy_timeout(Duration::from_secs(10))?;
            let mut statement = connection.prepare(&format!("PRAGMA quick_check({MOST_FAULTS})"))?;
            let lines =
                statement.query_map([], |row| row.get::<_, String>(0))?.collect::<Result<Vec<_>, _>>()?;
            // A line can hold several faults; "ok" stands alone.
            let faults = lines.iter().flat_map(|line| line.lines()).filter(|line| *line != "ok");
            Ok(faults.map(str::to_owned).collect())
        })
        .await
    }
}
