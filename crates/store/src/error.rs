use std::path::PathBuf;

/// Why the store could not do what it was asked. The text is for logs; none of it belongs in an answer to a browser.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The database refused or failed.
    #[error("database: {0}")]
    Database(#[from] sqlx::Error),
    /// The database could not be read for an analysis.
    #[error("reading answers: {0}")]
    Reading(#[from] rusqlite::Error),
    /// The database's layout could not be brought up to date.
    #[error("migrating the database: {0}")]
    Migrate(#[from] sqlx::migrate::MigrateError),
    /// A file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A stored file is not what its name says.
    #[error("stimulus {sha256}: the stored bytes have another hash; the file is damaged")]
    Damaged {
        /// The hash that the bytes should have.
        sha256: String,
    },
    /// Bytes that are to be shown are no picture.
    #[error("a stimulus {0}")]
    Undecodable(String),
    /// A stored text could not be read back.
    #[error("stored {what} cannot be read: {message}")]
    Corrupt {
        /// Which column or table.
        what: &'static str,
        /// What is wrong with it.
        message: String,
    },
}

impl StoreError {
    pub(crate) fn corrupt(what: &'static str, message: impl ToString) -> Self {
        StoreError::Corrupt { what, message: message.to_string() }
    }
}
