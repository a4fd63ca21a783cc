//! Nothing lost: sessions, answers and stimuli in SQLite (through rusqlite where it writes, sqlx for most reads) and in files named by their content.
//!
//! What a method has returned `Ok` for is committed and synced. One connection writes, so that the chain of answers has one
//! order; several read. [`Store`] is the one type the rest of kelir knows; which database is behind it is its own business.

mod answer_row;
mod answers;
mod background;
mod chain;
mod clock;
mod connection;
mod error;
mod files;
mod first_chain;
mod health;
mod import;
mod integrity;
mod layout;
mod lock;
mod open;
mod packing;
mod packings;
mod persons;
mod pixels;
mod place;
mod plans;
mod private;
mod readers;
mod reading;
mod researchers;
mod session_row;
mod sessions;
mod shown;
mod slots;
mod sqlite;
mod stimuli;
mod text;
mod threads;
mod upgrade;
mod versions;
mod writer;

pub use answer_row::{AnswerRow, ShownStimulus};
pub use answers::{Appended, NewAnswer, Progress, SentAnswer, StoredAnswer, Taken};
pub use background::{background, step_back};
pub use chain::{ChainReport, Fault};
pub use clock::micros;
pub use error::{StoreError, Trouble};
pub use files::sha256_hex;
pub use first_chain::GENESIS;
pub use import::ImportedSession;
pub use lock::FolderLock;
pub use packing::{PACKED, packed_bytes, step_bytes};
pub use packings::{PackedSize, Packing};
pub use persons::Begun;
pub use pixels::{ANIMATION, picture_size};
pub use plans::{NextTrials, PlannedSession, PlannedTrial, SizedStimuli, StimulusHashes};
pub use private::private_file;
pub use reading::StoredAnswers;
pub use session_row::{NewSession, Session, SessionKind};
pub use sessions::{Completed, Participants};
pub use shown::ShownSize;
pub use sqlite::Store;
pub use stimuli::{Render, StimulusInfo, StudyStimulus};
pub use versions::{StudyVersion, VersionCounts};
