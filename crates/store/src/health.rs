//! Whether the store can do its work: a write is tried, and the free space looked at.

use crate::error::{StoreError, Trouble};
use crate::sqlite::Store;

/// Less free space than this is not enough: answers are small, and a checkpoint copies what has gathered.
const LEAST_FREE_BYTES: u64 = 32 << 20;

impl Store {
    /// Writes something, syncs it and takes it away again.
    ///
    /// # Errors
    /// The trouble there is; [`Trouble::Full`] also where little space is left.
    pub async fn check(&self) -> Result<(), StoreError> {
        // First: where the folder is gone, the writer says so.
        self.write(|writer| {
            writer.prepare_cached("INSERT INTO probes DEFAULT VALUES")?.execute([])?;
            writer.prepare_cached("DELETE FROM probes")?.execute([])?;
            Ok(())
        })
        .await?;
        match self.free_bytes()? {
            Some(free) if free < LEAST_FREE_BYTES => {
                let message = format!("{} MB of the data folder's disk are free", free >> 20);
                Err(StoreError::trouble(Trouble::Full, message))
            }
            _ => Ok(()),
        }
    }

    /// Bytes that this process may still write on the data folder's disk; `None` where the system does not say.
    fn free_bytes(&self) -> Result<Option<u64>, StoreError> {
        #[cfg(unix)]
        {
            let stat = rustix::fs::statvfs(&self.folder);
            let stat =
                stat.map_err(|error| StoreError::File { path: self.folder.clone(), source: error.into() })?;
            Ok(Some(stat.f_bavail.saturating_mul(stat.f_frsize)))
        }
        #[cfg(not(unix))]
        Ok(None)
    }
}
