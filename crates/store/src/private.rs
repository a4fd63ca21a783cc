//! A data folder is its owner's alone: 700, and 600 for every file in it.

use crate::error::StoreError;
use std::fs::{DirBuilder, OpenOptions};
use std::path::Path;

/// Makes a folder that only its owner can enter; one that is there stays.
pub(crate) fn folder(path: &Path) -> Result<(), StoreError> {
    let mut builder = DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(path).map_err(|source| StoreError::File { path: path.to_owned(), source })
}

/// How every file of a data folder is written: only its owner can read it.
pub fn private_file() -> OpenOptions {
    let mut options = OpenOptions::new();
    options.write(true).create(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options
}

/// Takes others' rights to a folder and all in it away. What belongs to somebody else, or can't be written to, stays as it is: reading it may be
/// all that is wanted.
#[cfg(unix)]
pub(crate) fn close(path: &Path) {
    use std::os::unix::fs::PermissionsExt;
    let Ok(known) = path.symlink_metadata() else { return };
    let mode = known.permissions().mode();
    if !known.is_symlink() && mode & 0o077 != 0 {
        let _ = std::fs::set_permissions(path, PermissionsExt::from_mode(mode & 0o700));
    }
    if known.is_dir() {
        for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
            close(&entry.path());
        }
    }
}

/// Elsewhere rights are inherited.
#[cfg(not(unix))]
pub(crate) fn close(_: &Path) {}
