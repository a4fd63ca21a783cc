//! Whether the database is where it was opened: what is written to a file that has lost its name ends with the process.

use crate::error::{StoreError, Trouble};
use std::cell::Cell;
use std::io;
use std::path::{Path, PathBuf};

/// The database's file, by where it is and which file that is.
#[derive(Debug)]
pub(crate) struct Place {
    database: PathBuf,
    log: PathBuf,
    file: Option<(u64, u64)>,
    /// Whether there was a log: some file systems can't have one.
    has_log: Cell<bool>,
}

impl Place {
    /// The place of a database that is there.
    pub(crate) fn of(database: &Path) -> Result<Place, StoreError> {
        let unknown = |source| StoreError::File { path: database.to_owned(), source };
        let file = which(database).map_err(unknown)?;
        let mut log = database.as_os_str().to_owned();
        log.push("-wal");
        Ok(Place { database: database.to_owned(), log: log.into(), file, has_log: Cell::new(false) })
    }

    /// # Errors
    /// [`Trouble::Gone`]: the file is not there, or another one is.
    pub(crate) fn holds(&self) -> Result<(), StoreError> {
        match which(&self.database) {
            Ok(file) if file == self.file => Ok(()),
            Ok(_) => Err(gone(&self.database, "is another file than the one that was opened")),
            Err(error) => Err(gone(&self.database, error)),
        }
    }

    /// The same once something has been written, which lies in the log beside the database until it is brought into it.
    ///
    /// # Errors
    /// As [`Place::holds`].
    pub(crate) fn holds_what_was_written(&self) -> Result<(), StoreError> {
        self.holds()?;
        match which(&self.log) {
            Ok(_) => self.has_log.set(true),
            Err(error) if self.has_log.get() => return Err(gone(&self.log, error)),
            Err(_) => {}
        }
        Ok(())
    }
}

fn gone(path: &Path, why: impl std::fmt::Display) -> StoreError {
    StoreError::trouble(Trouble::Gone, format!("{}: {why}; put it back, or restart kelir", path.display()))
}

/// Which file it is, whatever it is called.
#[cfg(unix)]
fn which(path: &Path) -> io::Result<Option<(u64, u64)>> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().map(|known| Some((known.dev(), known.ino())))
}

/// Elsewhere a file that is open cannot be moved away.
#[cfg(not(unix))]
fn which(path: &Path) -> io::Result<Option<(u64, u64)>> {
    path.metadata().map(|_| None)
}
