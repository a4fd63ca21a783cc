//! Nothing lost: sessions, answers and stimuli in SQLite (through sqlx; rusqlite for the analyses' one long read) and in files named by their content.
//!
//! What a method has returned `Ok` for is committed and synced. One connection writes, so that the chain of answers has one
//! order; several read. [`Store`] is the one type the rest of kelir knows; which database is behind it is its own business.

mod answers;
mod chain;
mod clock;
mod error;
mod files;
mod import;
mod researchers;
mod responses;
mod sessions;
mod sqlite;
mod stimuli;
mod studies;

pub use answers::StoredAnswers;
pub use chain::{ChainReport, ChainRow, GENESIS};
pub use error::StoreError;
pub use files::sha256_hex;
pub use import::ImportedSession;
pub use responses::{Appended, NewResponse, ResponseRow};
pub use sessions::{Completed, NewSession, Participants, PlannedSession, PlannedTrial, Session};
pub use sqlite::Store;
pub use stimuli::{Render, StimulusInfo, StudyStimulus};
pub use studies::StudyVersion;
