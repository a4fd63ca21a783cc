//! The errors of starting.

use kelir_store::StoreError;
use kelir_study::Problems;
use std::path::PathBuf;

/// Why a study file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StudyFileError {
    /// Everything that is wrong with it, its scenes, conditions and pictures included.
    #[error("{0}")]
    Invalid(#[from] Problems),
    /// It cannot be read.
    #[error("{path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Why the server did not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data folder cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The key of signed links can be neither read nor made.
    #[error("link-key: {0}")]
    LinkKey(std::io::Error),
    /// The researcher's password cannot be set up.
    #[error("researcher password: {0}")]
    Password(String),
    /// The address cannot be listened on.
    #[error("cannot listen on {address}: {source}")]
    Listen {
        /// The address.
        address: std::net::SocketAddr,
        /// What the system said.
        source: std::io::Error,
    },
}
