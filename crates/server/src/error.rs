//! The errors of starting.

use kelir_store::StoreError;

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
