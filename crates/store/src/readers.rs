//! Connections that read, each in use by one at a time.

use crate::connection;
use crate::error::StoreError;
use crate::threads::blocking;
use rusqlite::Connection;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Connections that are kept for the next who reads.
const MOST_KEPT: usize = 8;

#[derive(Clone, Debug)]
pub(crate) struct Readers {
    path: PathBuf,
    idle: Arc<Mutex<Vec<Connection>>>,
}

impl Readers {
    pub(crate) fn new(path: PathBuf) -> Readers {
        Readers { path, idle: Arc::default() }
    }

    /// Reads, off the async threads. Each statement sees what is committed when it begins.
    pub(crate) async fn read<T: Send + 'static>(
        &self,
        job: impl FnOnce(&Connection) -> Result<T, StoreError> + Send + 'static,
    ) -> Result<T, StoreError> {
        let readers = self.clone();
        blocking(move || {
            let kept = readers.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
            let connection = kept.map_or_else(|| connection::reading(&readers.path), Ok)?;
            // One that failed is not kept.
            let value = job(&connection)?;
            let mut idle = readers.idle.lock().unwrap_or_else(PoisonError::into_inner);
            if idle.len() < MOST_KEPT {
                idle.push(connection);
            }
            Ok(value)
        })
        .await
    }

    pub(crate) fn close(&self) {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}
