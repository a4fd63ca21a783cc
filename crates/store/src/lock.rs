//! One server a data folder: a second one is told who holds it.

use crate::clock;
use crate::error::StoreError;
use crate::private;
use std::fs::{File, TryLockError};
use std::io::Write;
use std::path::Path;

/// The lock's file in a data folder.
const LOCK: &str = "kelir.lock";

/// A data folder that this process serves, until this is dropped or the process ends.
#[derive(Debug)]
pub struct FolderLock {
    /// The system unlocks what is closed.
    _file: File,
}

impl FolderLock {
    /// Takes a folder, which is made if need be, for a server at `address`.
    ///
    /// # Errors
    /// [`StoreError::Held`] where another process has it.
    pub fn take(folder: &Path, address: &str) -> Result<FolderLock, StoreError> {
        let path = folder.join(LOCK);
        let failed = |source| StoreError::File { path: path.clone(), source };
        private::folder(folder)?;
        let mut file = private::private_file().open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let holder = std::fs::read_to_string(&path).unwrap_or_default();
                let (folder, holder) = (folder.to_owned(), holder.trim().to_owned());
                return Err(StoreError::Held { folder, holder });
            }
            Err(TryLockError::Error(source)) => return Err(failed(source)),
        }
        let holder = format!("process {}, {address}, since {}\n", std::process::id(), clock::now());
        file.set_len(0).and_then(|()| file.write_all(holder.as_bytes())).map_err(failed)?;
        Ok(FolderLock { _file: file })
    }
}
