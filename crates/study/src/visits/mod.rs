//! Visits: whose each session is, what was noticed of it, and which of a person's sessions is judged.

mod balance;
mod identity;
mod judged;
mod pace;

pub use balance::{Balance, UnevenItem};
pub(crate) use identity::parameter;
pub use identity::{ID_PARAMETERS, LONGEST_ID, RefusedId};
pub use judged::{Judged, LeftOut, Repeated};
pub use pace::Pace;

use crate::schema::worded;

worded! {
    /// Whose a session is. The analysis is of participants alone.
    pub enum SessionKind {
        /// a participant's
        Participant = "participant",
        /// a researcher's trial run
        Pilot = "pilot",
        /// a simulation's
        Simulated = "simulated",
    }
}

#[expect(clippy::derivable_impls, reason = "`worded!` writes the enum")]
impl Default for SessionKind {
    fn default() -> SessionKind {
        SessionKind::Participant
    }
}

worded! {
    /// What can be known of a session besides its answers.
    pub enum Flag {
        /// the same id had begun the study before
        RepeatedId = "repeated_id",
        /// many sessions were begun at its network address within a short time
        ManyStarts = "many_starts",
        /// its response times need more time than had passed on the server's clock
        FasterThanClock = "faster_than_clock",
        /// an answer came without a response time that can be
        NoResponseTime = "no_response_time",
    }
}

impl Flag {
    /// The flag of this name; `None` for a word that is none.
    pub fn named(text: &str) -> Option<Flag> {
        Flag::ALL.iter().copied().find(|flag| flag.as_str() == text)
    }
}

/// A session as analyses need it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Visit {
    /// Session's id; those given later sort behind.
    pub session_id: String,
    /// The id that came with the link: one person's, whatever the session. `None`: nobody's but the session's own.
    pub person: Option<String>,
    /// Version of the study that it is of.
    pub version: String,
    /// Its place in that version's design.
    pub slot: u32,
    /// Whose it is.
    pub kind: SessionKind,
    /// What was noticed when it began.
    pub flags: Vec<Flag>,
    /// When consent was given, µs since 1970.
    pub consented_us: Option<i64>,
    /// When it was finished, µs since 1970.
    pub completed_us: Option<i64>,
    /// Whether it was heard of within the study's idle time.
    pub is_active: bool,
}

impl Visit {
    /// What was noticed of the session, by its answers too. A simulation's time is its own.
    pub fn flags(&self, pace: Pace) -> Vec<Flag> {
        let mut flags = self.flags.clone();
        let is_timed = self.kind != SessionKind::Simulated;
        if is_timed && pace.is_faster_than_clock(self.consented_us) {
            flags.push(Flag::FasterThanClock);
        }
        if pace.lacks_a_time() {
            flags.push(Flag::NoResponseTime);
        }
        flags.sort();
        flags.dedup();
        flags
    }
}

#[cfg(test)]
mod tests;
